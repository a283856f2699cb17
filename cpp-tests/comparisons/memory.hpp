/// \file
/// What is allocated, by whom ever: a program that links this has its `malloc` counted, and so that of
/// the C++ and of the Rust that it calls.
#pragma once

#include <cstddef>

namespace comparison {

/// Bytes of all blocks that are allocated now, as large as the allocator made them.
std::size_t allocated_bytes();

/// The most there were at once since the last `reset_peak_bytes`, on all threads together.
std::size_t peak_bytes();

/// Makes the bytes of now the peak.
void reset_peak_bytes();

} // namespace comparison
