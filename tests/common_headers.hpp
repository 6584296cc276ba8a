// SPDX-License-Identifier: BSD-3-Clause
// Headers that most tests include, for precompilation. No test relies on it.
#pragma once

#include <doctest/doctest.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <string>
#include <vector>
