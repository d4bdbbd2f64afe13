// A module as another build of pfvox would make it: only the first field of its table has a meaning here.
#ifdef PFVOX_FAKE_ENTRY
namespace {
struct OtherTable {
    const char* buildId = "0.0.0-fake";
};
constexpr OtherTable kTable;
}  // namespace

extern "C" const void* pfvoxVdbModule() {
    return &kTable;
}
#else
extern "C" int pfvoxNothing() {
    return 0;
}
#endif
