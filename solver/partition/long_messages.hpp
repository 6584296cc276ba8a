// SPDX-License-Identifier: BSD-3-Clause
// MPI messages of any length, sent in pieces because MPI counts are 32-bit.
#pragma once

#include <mpi.h>

#include <algorithm>
#include <cstddef>

namespace kacanov {

inline constexpr std::size_t longest_message = std::size_t{1} << 30;

inline void send_bytes(const void* data, std::size_t bytes, int to, MPI_Comm comm) {
  const char* p = static_cast<const char*>(data);
  for (std::size_t at = 0; at < bytes; at += longest_message)
    MPI_Send(p + at, static_cast<int>(std::min(longest_message, bytes - at)), MPI_BYTE, to, 1, comm);
}

inline void receive_bytes(void* data, std::size_t bytes, int from, MPI_Comm comm) {
  char* p = static_cast<char*>(data);
  for (std::size_t at = 0; at < bytes; at += longest_message)
    MPI_Recv(p + at, static_cast<int>(std::min(longest_message, bytes - at)), MPI_BYTE, from, 1, comm,
             MPI_STATUS_IGNORE);
}

}  // namespace kacanov
