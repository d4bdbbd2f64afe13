// AddressSanitizer and GPU drivers: llvmpipe leaks a little, which is not ours. The Vulkan loader unloads
// drivers before leaks are looked for, and then they have no name to be recognised by; so llvmpipe is kept
// loaded. Linked into every test program that opens a device.
#ifdef PFVOX_ADDRESS_SANITIZER

#include <dlfcn.h>

extern "C" const char* __lsan_default_suppressions() {
    return "leak:libvulkan_lvp\n";
}

namespace {
// Null where there is no such driver: nothing to keep then.
[[maybe_unused]] void* const kKeptDriver = dlopen("libvulkan_lvp.so", RTLD_NOW | RTLD_NODELETE);
}  // namespace

#endif
