/// \file
/// Memory as the system sees it: pages that are resident, whoever allocated them and however. Linux only.
#pragma once

#include <cstddef>
#include <optional>

namespace comparison {

/// Resident bytes from here on count as one peak: gives back what is free to the system, makes the bytes
/// of now the peak, and returns them; nothing where the system does not allow it.
std::optional<std::size_t> begin_peak();

/// The most bytes that were resident at once since `begin_peak`, on all threads together.
std::size_t peak_bytes();

} // namespace comparison
