// Device: selection, buffers, transfers larger than the staging buffer, memory accounts, errors.
#include <gmock/gmock.h>

#include <numeric>
#include <pfvox/gpu.hpp>
#include <pfvox_check_shaders/shaders.hpp>

#include "support/gpu_fixture.hpp"

namespace pfvox::test {
namespace {

using DeviceTest = GpuTest;
using ::testing::Contains;
using ::testing::HasSubstr;

std::vector<std::uint32_t> runningNumbers(std::size_t count) {
    std::vector<std::uint32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0u);
    return numbers;
}

TEST_F(DeviceTest, ListsDevicesInOrderOfTheirIndex) {
    PFVOX_ASSERT_VALUE(const auto, devices, gpu::listDevices());
    ASSERT_FALSE(devices.empty());
    for (std::size_t i = 0; i < devices.size(); ++i) EXPECT_EQ(devices[i].index, i);
}

TEST_F(DeviceTest, OpensByIndexAndByPartOfTheName) {
    const gpu::DeviceInfo wanted = device().info();
    std::vector<std::string> selectors{std::to_string(wanted.index), wanted.name.substr(1, 5)};
    // 256 of "llvmpipe (LLVM 15.0.6, 256 bits)" was taken for an index that there is not.
    const std::string name = wanted.name;
    for (std::size_t at = 0; at < name.size(); ++at) {
        const std::size_t end = std::min(name.find_first_not_of("0123456789", at), name.size());
        if (end - at >= 3) selectors.push_back(name.substr(at, end - at));
        at = end;
    }
    for (const std::string& selector : selectors) {
        PFVOX_ASSERT_VALUE(const gpu::Device, opened, gpu::Device::open({.selector = selector}));
        EXPECT_FALSE(opened.info().name.empty());
    }
}

TEST_F(DeviceTest, UnknownSelectorNamesTheDevicesThatAreThere) {
    const auto opened = gpu::Device::open({.selector = "no such device"});
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().code, ErrorCode::GpuUnavailable);
    EXPECT_THAT(opened.error().message, HasSubstr(device().info().name));
    EXPECT_FALSE(gpu::Device::open({.selector = "9999"}));
}

TEST_F(DeviceTest, ReturnsWhatWasUploaded) {
    const std::vector<std::uint32_t> numbers = runningNumbers(1000);
    PFVOX_ASSERT_VALUE(const gpu::Buffer, buffer, device().createBuffer(8000, "numbers"));
    EXPECT_EQ(buffer.address() % 256, 0u);
    ASSERT_TRUE(device().upload(buffer, 4000, std::as_bytes(std::span(numbers))));
    std::vector<std::uint32_t> back(500);
    ASSERT_TRUE(device().download(buffer, 4000 + 4 * 250, std::as_writable_bytes(std::span(back))));
    EXPECT_EQ(back, std::vector(numbers.begin() + 250, numbers.begin() + 750));
}

TEST_F(DeviceTest, TransfersMoreThanTheStagingBufferHolds) {
    const std::vector<std::uint32_t> numbers = runningNumbers(20u << 20);
    PFVOX_ASSERT_VALUE(const gpu::Buffer, buffer, device().createBuffer(4 * numbers.size(), "numbers"));
    ASSERT_TRUE(device().upload(buffer, 0, std::as_bytes(std::span(numbers))));
    std::vector<std::uint32_t> back(numbers.size());
    ASSERT_TRUE(device().download(buffer, 0, std::as_writable_bytes(std::span(back))));
    EXPECT_TRUE(back == numbers);
}

TEST_F(DeviceTest, StagingGrowsForOneLargePiece) {
    constexpr std::uint64_t kBytes = 40u << 20;
    PFVOX_ASSERT_VALUE(const gpu::Buffer, buffer, device().createBuffer(kBytes, "large"));
    PFVOX_ASSERT_VALUE(const std::span<std::byte>, room, device().stage(buffer, 0, kBytes));
    ASSERT_EQ(room.size(), kBytes);
    room.back() = std::byte{42};
    std::vector<std::byte> back(4);
    ASSERT_TRUE(device().download(buffer, kBytes - 4, back));
    EXPECT_EQ(back[3], std::byte{42});
}

TEST_F(DeviceTest, AccountsForItsMemory) {
    const gpu::MemoryUse before = device().memory();
    {
        PFVOX_ASSERT_VALUE(const gpu::Buffer, buffer, device().createBuffer(1 << 20, "counted"));
        EXPECT_EQ(device().memory().currentBytes, before.currentBytes + (1 << 20));
    }
    EXPECT_EQ(device().memory().currentBytes, before.currentBytes);
    EXPECT_GE(device().memory().peakBytes, before.currentBytes + (1 << 20));
}

TEST_F(DeviceTest, ValidationMessagesAreCollected) {
    // A device of its own: the one of the fixture has to stay silent.
    PFVOX_ASSERT_VALUE(gpu::Device, watched, gpu::Device::open({.validation = true}));
    constexpr std::uint32_t kMoreThanAnyDeviceHas = 1u << 16;
    const auto program =
        watched.createProgram(shaders::kLayoutCheck, kMoreThanAnyDeviceHas, "wrong on purpose");
    EXPECT_THAT(watched.validationMessages(), Contains(HasSubstr("VUID")));
}

TEST_F(DeviceTest, TooLargeABufferIsOutOfMemory) {
    const auto buffer = device().createBuffer(std::uint64_t{1} << 60, "too large");
    ASSERT_FALSE(buffer);
    EXPECT_EQ(buffer.error().code, ErrorCode::GpuOutOfMemory);
}

}  // namespace
}  // namespace pfvox::test
