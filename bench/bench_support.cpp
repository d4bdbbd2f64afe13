#include "bench_support.hpp"

#include <map>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace pfvox::bench {

const MeasuredModel& model(const std::string& name) {
    static std::map<std::string, MeasuredModel> cache;
    auto [entry, isNew] = cache.try_emplace(name);
    if (isNew) entry->second = makeMeasuredModel(name);
    return entry->second;
}

void setRate(benchmark::State& state, const MeasuredModel& source) {
    state.counters["Mvoxels/s"] = benchmark::Counter(static_cast<double>(source.voxels.size()) / 1e6,
                                                     benchmark::Counter::kIsIterationInvariantRate);
}

void releaseFreeMemory() {
#if defined(__GLIBC__)
    malloc_trim(0);
#endif
}

void setBytesPerVoxel(benchmark::State& state, const char* name, std::size_t bytes,
                      const MeasuredModel& source) {
    state.counters[name] = static_cast<double>(bytes) / static_cast<double>(source.voxels.size());
}

}  // namespace pfvox::bench
