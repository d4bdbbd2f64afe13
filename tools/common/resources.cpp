#include "common/resources.hpp"

#include <fcntl.h>
#include <sys/resource.h>

#include <algorithm>
#include <latch>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace pfvox::tools {

int startableThreads(int wanted) {
    if (wanted <= 0) return 0;
    std::latch counted(1);
    std::vector<std::thread> parked;
    parked.reserve(static_cast<std::size_t>(wanted));
    try {
        while (parked.size() < static_cast<std::size_t>(wanted)) parked.emplace_back([&] { counted.wait(); });
    } catch (const std::system_error&) {
    } catch (const std::bad_alloc&) {
    }
    counted.count_down();
    for (std::thread& thread : parked) thread.join();
    const int started = static_cast<int>(parked.size());
    return started == wanted ? wanted : started / 2;
}

std::size_t openableFiles() {
    constexpr std::size_t kEnough = 4096;
    constexpr std::size_t kReserve = 8;
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur > kEnough) return kEnough;
    std::size_t unused = 0;
    for (int fd = 0; fd < static_cast<int>(limit.rlim_cur); ++fd) unused += ::fcntl(fd, F_GETFD) < 0 ? 1u : 0u;
    return std::max<std::size_t>(unused, kReserve + 1) - kReserve;
}

}  // namespace pfvox::tools
