// SPDX-License-Identifier: BSD-3-Clause
// What most tests include, to be parsed once for all where headers are precompiled. No test relies on it.
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
