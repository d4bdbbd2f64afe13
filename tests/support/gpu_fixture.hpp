// A device for GPU tests: opened once a process, with the validation layer, which must stay silent.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <pfvox/gpu.hpp>

namespace pfvox::test {

/// PFVOX_TEST_DEVICE chooses the device (index or part of the name); default as everywhere. No usable device
/// is a failure, not a skip: llvmpipe runs everything.
class GpuTest : public ::testing::Test {
  protected:
    static gpu::Device& device() { return *device_; }

    void SetUp() override {
        if (device_) return;
        const char* const selector = std::getenv("PFVOX_TEST_DEVICE");
        Result<gpu::Device> opened =
            gpu::Device::open({.selector = selector != nullptr ? selector : "", .validation = true});
        ASSERT_TRUE(opened) << describe(opened.error());
        device_ = std::make_unique<gpu::Device>(*std::move(opened));
    }

    void TearDown() override {
        if (!device_) return;
        for (const std::string& message : device_->validationMessages()) ADD_FAILURE() << message;
    }

    static void TearDownTestSuite() { device_.reset(); }

  private:
    static inline std::unique_ptr<gpu::Device> device_;
};

/// The value of a Result; ends the test when there is none.
#define PFVOX_ASSERT_VALUE(type, name, ...)                               \
    auto name##Result = (__VA_ARGS__);                                    \
    ASSERT_TRUE(name##Result) << ::pfvox::describe(name##Result.error()); \
    type name = *std::move(name##Result)

}  // namespace pfvox::test
