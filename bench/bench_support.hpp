// What the benchmark programs have in common: the models, made once, and how a benchmark is registered.
#pragma once

#include <benchmark/benchmark.h>

#include <string>

#include "measured_models.hpp"

namespace pfvox::bench {

/// The measured model of this name; made when it is first asked for.
const MeasuredModel& model(const std::string& name);

/// Counter "Mvoxels/s": million voxels of the source in a second of wall time.
void setRate(benchmark::State& state, const MeasuredModel& source);

/// Gives what the allocator keeps in reserve back to the system, where that is possible.
void releaseFreeMemory();

/// Counter `name`: bytes per voxel of the source.
void setBytesPerVoxel(benchmark::State& state, const char* name, std::size_t bytes,
                      const MeasuredModel& source);

/// Drops `result` and gives free memory back to the system, outside of the timing. A converter builds once,
/// in memory that it has just been given: builds that find the pages of the last one look twice as fast as
/// they are.
template <class Result>
void startAfresh(benchmark::State& state, Result& result) {
    state.PauseTiming();
    result = Result{};
    releaseFreeMemory();
    state.ResumeTiming();
}

/// Registers "<model>/<what>" for `function(state, model name)`. Wall time decides; CPU time is that of all
/// threads.
template <class Function>
benchmark::internal::Benchmark* addBenchmark(const std::string& modelName, const std::string& what,
                                             Function function) {
    return benchmark::RegisterBenchmark((modelName + "/" + what).c_str(), function, modelName)
        ->Unit(benchmark::kMillisecond)
        ->MeasureProcessCPUTime()
        ->UseRealTime();
}

}  // namespace pfvox::bench
