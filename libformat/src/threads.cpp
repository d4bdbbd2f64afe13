#include <cstddef>
#include <latch>
#include <new>
#include <pfvox/threads.hpp>
#include <system_error>
#include <thread>
#include <vector>

namespace pfvox {

int startableThreads(int wanted) {
    if (wanted <= 0) return 0;
    std::latch counted(1);
    std::vector<std::thread> parked;
    try {
        parked.reserve(static_cast<std::size_t>(wanted));
        while (parked.size() < static_cast<std::size_t>(wanted)) parked.emplace_back([&] { counted.wait(); });
    } catch (const std::system_error&) {
    } catch (const std::bad_alloc&) {
    }
    counted.count_down();
    for (std::thread& thread : parked) thread.join();
    return static_cast<int>(parked.size());
}

}  // namespace pfvox
