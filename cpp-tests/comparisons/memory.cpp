#include "memory.hpp"

#include <fstream>
#include <malloc.h>
#include <stdexcept>
#include <string>

namespace comparison {
namespace {

/// What /proc/self/status says of `key`, in bytes.
std::size_t status(const std::string &key) {
    std::ifstream file("/proc/self/status");
    for (std::string word; file >> word;)
        if (std::size_t kibibytes = 0; word == key && file >> kibibytes)
            return 1024 * kibibytes;
    throw std::runtime_error("/proc/self/status has no " + key);
}

} // namespace

std::optional<std::size_t> begin_peak() {
    malloc_trim(0);
    std::ofstream file("/proc/self/clear_refs");
    // 5 resets the peak, see proc(5).
    if (!(file << "5" << std::flush))
        return std::nullopt;
    return status("VmRSS:");
}

std::size_t peak_bytes() { return status("VmHWM:"); }

} // namespace comparison
