#include "common/resources.hpp"

#include <fcntl.h>
#include <sys/resource.h>

#include <algorithm>
#include <pfvox/threads.hpp>

namespace pfvox::tools {

int affordableThreads(int wanted) {
    const int startable = startableThreads(wanted);
    return startable >= wanted ? wanted : startable / 2;
}

std::size_t openableFiles() {
    constexpr std::size_t kEnough = 4096;
    constexpr std::size_t kReserve = 8;
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur > kEnough) return kEnough;
    std::size_t unused = 0;
    for (int fd = 0; fd < static_cast<int>(limit.rlim_cur); ++fd)
        unused += ::fcntl(fd, F_GETFD) < 0 ? 1u : 0u;
    return std::max<std::size_t>(unused, kReserve + 1) - kReserve;
}

}  // namespace pfvox::tools
