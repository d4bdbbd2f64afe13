// Gpu: a thin floor of Vulkan 1.2 under everything that pfvox computes on a graphics card.
//
//     Device -> Buffer, Program -> run(dispatches) -> download
//
// It knows compute and nothing else: one queue, buffers reached by their device address, programs that take
// everything through push constants (hence no descriptor sets), one timeline semaphore, time stamps. Windows
// are the viewer's.
//
// Ownership: Device, Buffer and Program are movable handles; buffers and programs keep their device alive.
// Threading: one thread at a time for a device and everything made from it; different devices are
// independent. Errors: GpuUnavailable (no loader, no fitting device, a missing feature or layer),
// GpuOutOfMemory, GpuLost. After GpuLost every later call on that device fails.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <pfvox/error.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

struct VkBuffer_T;

namespace pfvox::gpu {

namespace detail {
class DeviceContext;
struct BufferState;
struct ProgramState;
}  // namespace detail

struct NativeDevice;
struct NativeQueueFamily;
/// What kind of device it is.
enum class DeviceKind : std::uint8_t { Discrete, Integrated, Virtual, Other, Software };

/// The spelling used in reports: "discrete", "integrated", ...
const char* toString(DeviceKind kind);
/// A Vulkan device, whether we can use it or not.
struct DeviceInfo {
    std::uint32_t index = 0;  ///< position in listDevices(); selects the device
    std::string name;
    DeviceKind kind = DeviceKind::Other;
    std::string driver;                 ///< driver name and version, as the driver spells them
    std::uint32_t apiVersionMajor = 0;  ///< of the device, not of the loader
    std::uint32_t apiVersionMinor = 0;  ///< of the device, not of the loader
    std::uint64_t localMemoryBytes =
        0;                ///< largest device-local heap, or DeviceOptions::memoryBytes if that is less
    std::string missing;  ///< what pfvox needs and the device lacks; empty = usable
    bool usable() const { return missing.empty(); }
};

/// Every Vulkan device of the machine, usable or not. Errors: GpuUnavailable when there is no Vulkan loader
/// or driver.
Result<std::vector<DeviceInfo>> listDevices();
/// How a device is chosen and opened.
struct DeviceOptions {
    /// Empty: the first usable device, real ones before software. A number that is an index in listDevices():
    /// that one. Else the first with this part in its name, whatever its case.
    std::string selector;
    /// The most device and staging memory to take, for cards that others use too; 0 = what there is.
    std::uint64_t memoryBytes = 0;
    /// Turns VK_LAYER_KHRONOS_validation on; its messages are collected, see Device::validationMessages().
    bool validation = false;
    /// Further extensions for whoever shares the device (pfvox/gpu_native.hpp). A device without them is not
    /// usable.
    std::vector<std::string> instanceExtensions = {};
    std::vector<std::string> deviceExtensions = {};
    /// When set, the queue draws as well as computes and is one for which this is true.
    std::function<bool(const NativeQueueFamily&)> queueFits = {};
};

/// Device memory reached by address. Its first content is unspecified.
class Buffer {
  public:
    Buffer(Buffer&&) noexcept;
    Buffer& operator=(Buffer&&) noexcept;
    ~Buffer();

    std::uint64_t sizeBytes() const;
    /// What shaders see, low word first. A multiple of 256.
    std::uint64_t address() const;
    glm::uvec2 addressWords(std::uint64_t offsetBytes = 0) const {
        const std::uint64_t a = address() + offsetBytes;
        return {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(a >> 32)};
    }  ///< low and high half of the address of a byte

  private:
    friend class Device;
    friend VkBuffer_T* nativeOf(const Buffer& buffer);
    explicit Buffer(std::unique_ptr<detail::BufferState> state);
    std::unique_ptr<detail::BufferState> state_;
};

/// A compute shader with its pipeline. Its entry point is `main`.
class Program {
  public:
    Program(Program&&) noexcept;
    Program& operator=(Program&&) noexcept;
    ~Program();

  private:
    friend class Device;
    explicit Program(std::unique_ptr<detail::ProgramState> state);
    std::unique_ptr<detail::ProgramState> state_;
};

/// One launch of a program. `pushConstants` has the size that the program was made with.
struct Dispatch {
    const Program* program = nullptr;          ///< what runs; must outlive the dispatch
    std::span<const std::byte> pushConstants;  ///< as many bytes as the program declares
    glm::uvec3 groups{1};                      ///< work groups along x, y, z
    /// When set, the device reads the workgroups from there at launch: three words at `groupsAtBytes`, a
    /// multiple of 4.
    const Buffer* groupsFrom = nullptr;
    std::uint64_t groupsAtBytes = 0;  ///< where in that buffer, a multiple of 4
};

/// The bytes of a push constant block.
template <class T>
std::span<const std::byte> bytesOf(const T& block) {
    return std::as_bytes(std::span(&block, 1));
}
/// Memory of the device that this process has taken through it.
struct MemoryUse {
    std::uint64_t currentBytes = 0;  ///< buffers and staging that exist now
    std::uint64_t peakBytes = 0;
};

/// One opened GPU (or llvmpipe, which computes the same on the CPU).
class Device {
  public:
    /// Errors: GpuUnavailable; the message names the devices that are there.
    static Result<Device> open(const DeviceOptions& options);

    Device(Device&&) noexcept;
    Device& operator=(Device&&) noexcept;
    ~Device();

    const DeviceInfo& info() const;
    MemoryUse memory() const;  ///< buffers of this device, now and at most
    /// The largest buffer that createBuffer can make.
    std::uint64_t maxBufferBytes() const;

    /// Makes a buffer of at least one byte in device memory. `name` appears in validation messages.
    Result<Buffer> createBuffer(std::uint64_t sizeBytes, std::string_view name);

    /// Compiles a SPIR-V module whose only input is a push constant block of `pushConstantBytes` (at most
    /// 128). `constants[i]` is the value of its specialisation constant i; those beyond keep their defaults.
    Result<Program> createProgram(std::span<const std::uint32_t> spirv, std::uint32_t pushConstantBytes,
                                  std::string_view name, std::span<const std::uint32_t> constants = {});

    /// Room of `sizeBytes` (a multiple of 4) to be filled by the caller; its content goes to `target` at
    /// `offsetBytes` (a multiple of 4) with the next run(), download() or flush(). The room is valid until
    /// the next call on this device.
    Result<std::span<std::byte>> stage(const Buffer& target, std::uint64_t offsetBytes,
                                       std::uint64_t sizeBytes);
    /// stage() and copy, in pieces where needed.
    Result<void> upload(const Buffer& target, std::uint64_t offsetBytes, std::span<const std::byte> bytes);
    /// Carries out the copies that are still waiting.
    Result<void> flush();
    /// Copies a part of a buffer to the caller; offset and size are multiples of 4.
    Result<void> download(const Buffer& source, std::uint64_t offsetBytes, std::span<std::byte> bytes);

    /// Launches the programs one after the other, each seeing what those before wrote, and waits. Returns the
    /// time that the device spent, in milliseconds; 0 where it has no time stamps.
    Result<double> run(std::span<const Dispatch> dispatches);
    /// The same, and what each of them took, in milliseconds.
    Result<std::vector<double>> runTimed(std::span<const Dispatch> dispatches);

    /// What the validation layer has said so far, each message once an occurrence. Empty is how it should be.
    std::vector<std::string> validationMessages() const;

  private:
    friend NativeDevice nativeOf(const Device& device);
    explicit Device(std::shared_ptr<detail::DeviceContext> context);
    std::shared_ptr<detail::DeviceContext> context_;
};

}  // namespace pfvox::gpu
