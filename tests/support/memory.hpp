// How much memory a piece of a test takes at most: for tests that damaged files cause no wild allocation.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>

namespace pfvox::test {

namespace detail {
/// A field of /proc/self/status in bytes; 0 where there is none.
inline std::uint64_t statusBytes(const std::string& field) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with(field)) return std::stoull(line.substr(field.size())) * 1024;
    }
    return 0;
}
}  // namespace detail

/// Measures the highest resident memory from its making on.
class ResidentPeak {
  public:
    ResidentPeak() {
        std::ofstream("/proc/self/clear_refs") << "5";  // forget the peak so far
        start_ = detail::statusBytes("VmRSS:");
    }
    /// How far above the start the peak lies. Zero under AddressSanitizer, which keeps freed memory for a
    /// while.
    std::uint64_t growthBytes() const {
#ifdef PFVOX_ADDRESS_SANITIZER
        return 0;
#endif
        const std::uint64_t peak = detail::statusBytes("VmHWM:");
        return peak > start_ ? peak - start_ : 0;
    }

  private:
    std::uint64_t start_ = 0;
};

}  // namespace pfvox::test
