// A module as another build of pfvox would make it: only the first field of its table has a meaning here.
#ifdef PFVOX_FAKE_ENTRY
namespace pfvox {
struct VdbModule {
    const char* buildId = "0.0.0-fake";
};
}  // namespace pfvox

extern "C" const pfvox::VdbModule* pfvoxVdbModule() {
    static constexpr pfvox::VdbModule kTable;
    return &kTable;
}
#else
extern "C" int pfvoxNothing() {
    return 0;
}
#endif
