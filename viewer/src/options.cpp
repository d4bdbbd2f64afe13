#include "options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <vector>

#include "common/command_line.hpp"
#include "common/help_page.hpp"
#include "common/text.hpp"
#include "common/unknown_option.hpp"

namespace pfvox::viewer {

namespace {

constexpr int kUsageError = 2;
constexpr std::uint32_t kMaxEdge = 16384;
constexpr std::uint32_t kSamplesWithoutScreenshot = 1;

tools::HelpText helpText() {
    using tools::ExitCode;
    return {
        .summary = "pfview shows a .pf_vox file or a scene of such files, in a window or as a picture.",
        .usage = {"pfview [options] [file.pf_vox | scene.toml | file.pf_probe | folder]"},
        .examples =
            {{"pfview hall.pf_vox", "a window"},
             {"pfview scene.toml --camera court", "at a camera of the scene"},
             {"pfview hall.pf_vox --screenshot hall.png", "a picture"},
             {"pfview hall.pf_vox --screenshot hall.png --size 640x480 --view normals", "of something else"},
             {"pfview scene.toml --screenshot court.png --camera court --frames 16", "with less noise"},
             {"pfview scene.toml --screenshot flight.png --camera-path flight.json --frames 120", "a flight"},
             {"pfview hall.pf_vox --screenshot hall.png --camera 4,3,8,0,1,0,50 --stats-json -",
              "with figures"},
             {"pfview scene.toml --probes scene.pf_probe --view tiers --screenshot tiers.png",
              "where light comes from"},
             {"pfview scene.toml --size 1920x1080 --frames 1000 --stats-json -", "figures of frames alone"}},
        .details = {"With --screenshot no window system is needed."},
        .exitCodes = {ExitCode::Ok, ExitCode::Usage, ExitCode::CannotReadOrWrite, ExitCode::InvalidInput,
                      ExitCode::Unsupported, ExitCode::Gpu, ExitCode::Internal}};
}

template <class Entries>
std::vector<std::string> wordsOf(const Entries& entries) {
    std::vector<std::string> words;
    for (const auto& entry : entries) words.emplace_back(entry.name);
    return words;
}

/// The whole text as numbers between separators; nothing if any part is not a finite number.
std::optional<std::vector<double>> numbersIn(const std::string& text, char separator) {
    std::vector<double> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    for (;;) {
        double value = 0.0;
        const auto [rest, error] = std::from_chars(at, end, value);
        if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
        numbers.push_back(value);
        if (rest == end) return numbers;
        if (*rest != separator) return std::nullopt;
        at = rest + 1;
    }
}

void parseSize(const std::string& text, PictureSettings& picture) {
    const auto numbers = numbersIn(text, 'x');
    const auto isEdge = [](double v) { return v >= 1.0 && v <= kMaxEdge && v == std::floor(v); };
    if (!numbers || numbers->size() != 2 || !isEdge((*numbers)[0]) || !isEdge((*numbers)[1])) {
        throw CLI::ValidationError(
            "--size", fmt::format("'{}' is not WIDTHxHEIGHT with edges from 1 to {}", text, kMaxEdge));
    }
    picture.width = static_cast<std::uint32_t>((*numbers)[0]);
    picture.height = static_cast<std::uint32_t>((*numbers)[1]);
}

/// A place that is written in numbers. Nothing for any other text, which is a name.
std::optional<ViewCamera> parseCamera(const std::string& text) {
    const auto numbers = numbersIn(text, ',');
    if (!numbers || numbers->size() == 1) return std::nullopt;
    const std::vector<double>& n = *numbers;
    if (n.size() != 6 && n.size() != 7)
        throw CLI::ValidationError("--camera", fmt::format("'{}' is not px,py,pz,tx,ty,tz[,fovY]", text));
    ViewCamera camera{.position = {n[0], n[1], n[2]}, .target = {n[3], n[4], n[5]}};
    if (n.size() == 7) camera.fovYDegrees = n[6];
    if (camera.position == camera.target)
        throw CLI::ValidationError("--camera", "position and target are the same");
    if (camera.fovYDegrees < 1.0 || camera.fovYDegrees > 170.0) {
        throw CLI::ValidationError("--camera", "the field of view is not within 1 to 170 degrees");
    }
    return camera;
}

/// Options as CLI11 hands them over, before their text is understood.
struct RawOptions {
    std::string size;
    std::string camera;
    std::string view;
    std::string toneMap;
    double exposureStops = 0.0;
    CLI::Option* exposure = nullptr;
    CLI::Option* samples = nullptr;
};

/// "a, b or c".
template <class Entries>
std::string namesOf(const Entries& entries) {
    std::string names;
    for (std::size_t i = 0; i < entries.size(); ++i)
        names += (i == 0 ? "" : i + 1 == entries.size() ? " or " : ", ") + std::string(entries[i].name);
    return names;
}

/// "there is no view 'finale'; did you mean final? There is ...".
template <class Entries>
std::string noSuch(std::string_view kind, const std::string& word, const Entries& entries) {
    const auto nearest = tools::nearestWord(word, wordsOf(entries));
    return fmt::format("there is no {} '{}'; {}there is {}", kind, word,
                       nearest ? "did you mean " + *nearest + "? " : "", namesOf(entries));
}

/// A picture in another format under this name would not be what it says.
void checkPngName(const std::string& option, const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
    if (extension != ".png")
        throw CLI::ValidationError(
            option, fmt::format("'{}' does not end in .png, and PNG is all that is written", file.string()));
}

void declareLight(CLI::App& app, Options& options, RawOptions& raw) {
    CLI::Option_group* const light = app.add_option_group("Light");
    CLI::Option* const probes =
        light->add_option("--probes", options.probes.file, "Indirect light from this .pf_probe file")
            ->type_name("FILE")
            ->check(tools::showDefault("the one beside the scene, by its name"))
            ->check(tools::suggestFiles({".pf_probe"}));
    light
        ->add_flag("--no-probes", options.probes.none,
                   "Guess indirect light from what is near by even if there are probes")
        ->excludes(probes);
    tools::addSwitch(*light, "ground", options.ground, "A ground under what is shown, with its shadow",
                     "under a single model, not in scenes");
    raw.exposure =
        light->add_option("--exposure", raw.exposureStops, "Stops brighter, -16 to 16")
            ->check(CLI::Range(-16.0, 16.0))
            ->check(tools::showDefault(fmt::format("{}, of a window what it was last", raw.exposureStops)))
            ->type_name("STOPS");
    light->add_option("--tonemap", raw.toneMap, namesOf(toneMaps()))
        ->type_name("NAME")
        ->check(tools::showDefault(
            fmt::format("{}, of a window what it was last", toString(options.picture.toneMap))))
        ->check(tools::suggestWords(wordsOf(toneMaps())));
    light
        ->add_option("--probe", options.picture.atlas.probe,
                     "Views of the atlas: this probe alone, by its index")
        ->check(CLI::Range(0, 1 << 30))
        ->type_name("N");
    light
        ->add_option("--probe-page", options.picture.atlas.page,
                     "Views of the atlas: this page of probes, from 0")
        ->check(CLI::Range(0u, 1u << 30))
        ->type_name("N");
}

void declare(CLI::App& app, Options& options, RawOptions& raw) {
    app.add_option("file", options.file,
                   "The .pf_vox file, scene (.toml), .pf_probe file beside its scene, or folder to look at")
        ->type_name("FILE")
        ->check(tools::suggestFiles({".pf_vox", ".toml", ".pf_probe"}));

    CLI::Option_group* const picture = app.add_option_group("Picture");
    picture
        ->add_option("--screenshot", options.screenshot,
                     "Write a PNG and exit instead of opening a window; needs no window system")
        ->type_name("PNG")
        ->check(tools::outputPath())
        ->check(tools::suggestFiles({".png"}));
    picture->add_option("--size", raw.size, "Pixels")
        ->type_name("WxH")
        ->check(tools::showDefault(fmt::format("{}x{}, of a window what it was last", options.picture.width,
                                               options.picture.height)));
    picture
        ->add_option("--camera", raw.camera,
                     "Name of a camera; else px,py,pz,tx,ty,tz[,fovY] in meters and degrees")
        ->type_name("CAMERA")
        ->check(tools::showDefault("the scene's first camera, else one that frames everything"));
    picture->add_option("--view", raw.view, namesOf(viewModes()))
        ->type_name("MODE")
        ->check(tools::showDefault(std::string(toString(options.picture.mode))))
        ->check(tools::suggestWords(wordsOf(viewModes())));
    raw.samples =
        picture
            ->add_option("--samples", options.picture.samplesPerPixel,
                         "Camera rays for each pixel and frame, 1 to 256")
            ->check(CLI::Range(1u, 256u))
            ->check(tools::showDefault(fmt::format(
                "{}, without --screenshot {}", options.picture.samplesPerPixel, kSamplesWithoutScreenshot)))
            ->type_name("N");

    picture
        ->add_option(
            "--frames", options.frames,
            "Frames of which the picture is the mean, as in the window; with --camera-path: numbered "
            "pictures; without --screenshot: frames that are measured. 1 to 100000")
        ->check(CLI::Range(1u, 100000u))
        ->check(tools::showDefault(options.frames))
        ->type_name("N");
    picture
        ->add_option("--camera-path", options.cameraPath,
                     "Fly through the cameras of a JSON file; writes PNG-0001.png and so on")
        ->type_name("JSON")
        ->check(tools::suggestFiles({".json"}));
    picture
        ->add_option("--lod-pixels", options.picture.lodPixels,
                     "Levels of detail narrower than this stand for what is in them; 0 to 64, 0 = none")
        ->check(CLI::Range(0.0, 64.0))
        ->check(tools::showDefault(options.picture.lodPixels))
        ->type_name("N");

    declareLight(app, options, raw);

    CLI::Option_group* const device = app.add_option_group("Device");
    device->add_option("--device", options.device, "Index, or else part of the name")
        ->type_name("X")
        ->check(tools::showDefault("the first real GPU, else the first device"));
    device->add_flag("--list-devices", options.listDevices, "Print the Vulkan devices and exit");
    device->add_flag("--validate", options.validation,
                     "Run with the Vulkan validation layer; its messages are failures");

    CLI::Option_group* const output = app.add_option_group("Output");
    output
        ->add_option(
            "--stats-json", options.statisticsFile,
            "Write statistics as JSON; - is stdout. Without --screenshot no picture is made: for measuring")
        ->type_name("FILE")
        ->check(tools::suggestFiles({".json"}));
    output->add_flag("-q,--quiet", options.quiet, "No messages but errors");
}

void understand(const RawOptions& raw, Options& options) {
    options.sizeGiven = !raw.size.empty();
    if (options.sizeGiven) parseSize(raw.size, options.picture);
    options.camera = {.camera = parseCamera(raw.camera), .name = raw.camera};
    if (!raw.view.empty()) {
        const std::optional<ViewMode> mode = viewModeFrom(raw.view);
        if (!mode) throw CLI::ValidationError("--view", noSuch("view", raw.view, viewModes()));
        options.picture.mode = *mode;
    }
    if (raw.exposure->count() != 0) options.exposureStops = raw.exposureStops;
    if (!raw.toneMap.empty()) {
        options.toneMap = toneMapFrom(raw.toneMap);
        if (!options.toneMap)
            throw CLI::ValidationError("--tonemap", noSuch("tone map", raw.toneMap, toneMaps()));
    }
    options.picture.toneMap = options.toneMap.value_or(PictureSettings{}.toneMap);
    if (options.screenshot.empty() && raw.samples->count() == 0)
        options.picture.samplesPerPixel = kSamplesWithoutScreenshot;
    if (options.listDevices) return;
    if (!options.screenshot.empty()) checkPngName("--screenshot", options.screenshot);
    if (options.screenshot.empty()) {
        if (!options.cameraPath.empty()) throw CLI::ValidationError("--camera-path", "needs --screenshot");
        if (options.frames != 1 && !options.isHeadless())
            throw CLI::ValidationError("--frames", "needs --screenshot or --stats-json");
        if (!options.isHeadless()) return;
    }
    if (options.file.empty()) throw CLI::ValidationError("file", "a .pf_vox file or a scene is needed");
}

}  // namespace

std::variant<Options, EarlyExit> parseOptions(int argc, const char* const* argv) {
    const auto tool = tools::makeTool(
        "pfview", helpText(), fmt::format("pfview {}\nreads PF_VOX 1.x, PF_PROBE 1.x", PFVOX_VERSION));
    CLI::App& app = *tool;
    Options options;
    RawOptions raw;
    try {
        declare(app, options, raw);
        app.parse(argc, argv);
        understand(raw, options);
    } catch (const CLI::CallForHelp&) {
        return EarlyExit{.exitCode = 0, .text = app.help()};
    } catch (const CLI::CallForVersion& version) {
        return EarlyExit{.exitCode = 0, .text = std::string(version.what()) + "\n"};
    } catch (const CLI::ParseError& error) {
        const std::string complaint = tools::complaintAboutUnknownOption(app, app).value_or(error.what());
        return EarlyExit{.exitCode = kUsageError,
                         .text = fmt::format("pfview: {}\nTry 'pfview --help'.\n", complaint)};
    }
    return options;
}

}  // namespace pfvox::viewer
