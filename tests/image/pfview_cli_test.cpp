// pfview as a program: arguments in, exit code, stdout, stderr and files out.
#include <algorithm>

#include "png.hpp"
#include "support/pfview_run.hpp"

namespace pfvox::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;
namespace fs = std::filesystem;

TEST_F(PfviewCli, WritesAScreenshot) {
    writeRoom("my room.pf_vox");
    const Outcome r = run("'my room.pf_vox' --screenshot a.png --size 64x48 --samples 1 --validate");
    EXPECT_EQ(r.exitCode, 0) << r.err;
    EXPECT_THAT(r.out, IsEmpty());
    const auto picture = viewer::readPng(folder_ / "a.png");
    ASSERT_TRUE(picture) << describe(picture.error());
    EXPECT_EQ(picture->width, 64u);
    EXPECT_EQ(picture->height, 48u);
}

TEST_F(PfviewCli, WritesStatisticsAndNothingElseToStdout) {
    writeRoom("a.pf_vox");
    const Outcome r =
        run("a.pf_vox --screenshot a.png --size 32x32 --view steps --camera 3,2,20,3,2,3,30 --stats-json -");
    EXPECT_EQ(r.exitCode, 0) << r.err;
    EXPECT_THAT(r.out, StartsWith("{"));
    EXPECT_THAT(r.out, HasSubstr("\"stepLimitRays\": 0"));
    EXPECT_THAT(r.out, HasSubstr("\"view\": \"steps\""));
}

TEST_F(PfviewCli, HelpAndVersionGoToStdout) {
    for (const char* const argument : {"--help", "-h", "--version"}) {
        const Outcome r = run(argument);
        EXPECT_EQ(r.exitCode, 0);
        EXPECT_THAT(r.out, HasSubstr("pfview"));
        EXPECT_THAT(r.err, IsEmpty());
    }
}

TEST_F(PfviewCli, WrongUsageIsShortAndOnStderr) {
    writeRoom("a.pf_vox");
    const std::string picture = "a.pf_vox --screenshot a.png ";
    for (const std::string& arguments : {std::string("--no-such-option"),
                                         std::string("a.pf_vox --frames 2"),
                                         picture + "--exposure 17",
                                         picture + "--tonemap film",
                                         picture + "--probes a.pf_probe --no-probes",
                                         picture + "--probe -1",
                                         std::string("a.pf_vox --camera-path b.json"),
                                         std::string("--screenshot a.png"),
                                         picture + "--frames 0",
                                         picture + "--lod-pixels -1",
                                         picture + "--size 0x5",
                                         picture + "--size 99999x5",
                                         picture + "--size 12",
                                         picture + "--camera 1,2,3",
                                         picture + "--camera 1,2,3,1,2,3",
                                         picture + "--camera 1,2,3,4,5,6,180",
                                         picture + "--view nothing",
                                         picture + "--samples 0",
                                         picture + "--samples 1e9",
                                         picture + "surplus"}) {
        const Outcome r = run(arguments);
        EXPECT_EQ(r.exitCode, 2) << arguments;
        EXPECT_THAT(r.out, IsEmpty()) << arguments;
        EXPECT_THAT(r.err, StartsWith("pfview: ")) << arguments;
        EXPECT_LT(std::ranges::count(r.err, '\n'), 4) << arguments;
        EXPECT_FALSE(fs::exists(folder_ / "a.png")) << arguments;
    }
}

TEST_F(PfviewCli, WhatIsMisspeltIsNamedWithWhatThereIs) {
    writeRoom("a.pf_vox");
    EXPECT_THAT(run("a.pf_vox --screnshot a.png").err,
                HasSubstr("unknown option --screnshot; did you mean --screenshot?"));
    const std::string view = run("a.pf_vox --screenshot a.png --view nromals").err;
    EXPECT_THAT(view, HasSubstr("did you mean normals?"));
    EXPECT_THAT(view, HasSubstr("atlas-normals or atlas-depth"));
    EXPECT_THAT(run("a.pf_vox --screenshot a.png --tonemap film").err,
                HasSubstr("reinhard, aces or neutral"));
    const Outcome picture = run("a.pf_vox --screenshot a.jpg");
    EXPECT_EQ(picture.exitCode, 2);
    EXPECT_THAT(picture.err, HasSubstr("'a.jpg' does not end in .png"));
    EXPECT_FALSE(fs::exists(folder_ / "a.jpg"));
    EXPECT_EQ(run("a.pf_vox --screenshot A.PNG --size 8x8").exitCode, 0);
}

TEST_F(PfviewCli, DamagedFilesSayWhatToDo) {
    writeRoom("a.pf_vox");
    const std::string good = contentOf(folder_ / "a.pf_vox");
    write("b.pf_vox", good.substr(0, good.size() - 9));
    EXPECT_THAT(run("b.pf_vox --screenshot a.png").err, HasSubstr("convert its source again"));
    std::string other = good;
    other[8] = 2;  // the major version
    write("b.pf_vox", other);
    EXPECT_THAT(
        run("b.pf_vox --screenshot a.png").err,
        HasSubstr(
            "PF_VOX 2.0; this program reads 1.x: convert the source again with this version of vox2pf"));
    write("b.pf_vox",
          "neither this program's nor its predecessor's, and long enough for a header .............");
    EXPECT_THAT(run("b.pf_vox --screenshot a.png").err, HasSubstr("vox2pf convert <source> -o 'b.pf_vox'"));
}

TEST_F(PfviewCli, SourceFileGetsTheCommandToRun) {
    write("hall.vox", "VOX \x96\0\0\0 and so on, long enough to have a header of some kind ..............");
    const Outcome r = run("hall.vox --screenshot a.png");
    EXPECT_EQ(r.exitCode, 4);
    EXPECT_THAT(r.err, HasSubstr("vox2pf convert 'hall.vox' -o 'hall.pf_vox'"));
    EXPECT_FALSE(fs::exists(folder_ / "a.png"));
}

TEST_F(PfviewCli, SceneIsDrawnByItsCameras) {
    writeRoom("room.pf_vox");
    write("s.toml",
          "[[cameras]]\nname = 'near'\nposition = [3, 2, 9]\ntarget = [3, 2, 0]\n"
          "[[cameras]]\nname = 'far'\nposition = [3, 2, 90]\ntarget = [3, 2, 0]\nfovYDegrees = 30\n"
          "[[models]]\npath = 'room.pf_vox'\n[[models]]\npath = 'room.pf_vox'\ntranslateVec = [8, 0, 0]\n");
    const std::string picture = "s.toml --screenshot a.png --size 32x32 --samples 1 --stats-json - ";
    const Outcome far = run(picture + "--camera far");
    EXPECT_EQ(far.exitCode, 0) << far.err;
    EXPECT_THAT(far.err, ::testing::StartsWith("note: no probes: indirect light is an approximation"));
    EXPECT_THAT(far.out, HasSubstr("\"fovYDegrees\": 30.0"));
    EXPECT_THAT(far.out, HasSubstr("\"instances\": 2,"));
    const Outcome first = run(picture);
    EXPECT_THAT(first.out, HasSubstr("\"fovYDegrees\": 45.0")) << "the scene's first camera";
    const Outcome none = run(picture + "--camera middle");
    EXPECT_EQ(none.exitCode, 4);
    EXPECT_THAT(none.err, HasSubstr("there is no camera 'middle'; there is 'near', 'far'"));
    EXPECT_THAT(run(picture + "--camera 3,2,9,3,2,0,60").out, HasSubstr("\"fovYDegrees\": 60.0"));
}

TEST_F(PfviewCli, BrokenSceneAndSceneOfSourcesTellWhatToDo) {
    write("s.toml", "[[models]]\npath = 'hall.vox'\n");
    const Outcome missing = run("s.toml --screenshot a.png");
    EXPECT_EQ(missing.exitCode, 3);
    EXPECT_THAT(missing.err, HasSubstr("s.toml: line 2, column 8: hall.vox"));
    write("hall.vox", "VOX \x96\0\0\0 and so on, long enough to have a header of some kind ..............");
    const Outcome source = run("s.toml --screenshot a.png");
    EXPECT_EQ(source.exitCode, 4);
    EXPECT_THAT(source.err, HasSubstr("vox2pf convert 'hall.vox' -o 'hall.pf_vox'"));
    write("s.toml", "[sun]\ndirection = 1\n");
    const Outcome broken = run("s.toml --screenshot a.png");
    EXPECT_EQ(broken.exitCode, 4);
    EXPECT_THAT(broken.err, HasSubstr("s.toml: line 2, column 13: direction is a list of 3 numbers"));
    EXPECT_FALSE(fs::exists(folder_ / "a.png"));
}

TEST_F(PfviewCli, FramesGiveThePictureOfAllTheirSamples) {
    writeRoom("a.pf_vox");
    const std::string small = "a.pf_vox --size 64x48 --validate --screenshot ";
    EXPECT_EQ(run(small + "frames.png --samples 2 --frames 3").exitCode, 0);
    EXPECT_EQ(run(small + "samples.png --samples 6").exitCode, 0);
    const auto frames = viewer::readPng(folder_ / "frames.png");
    const auto samples = viewer::readPng(folder_ / "samples.png");
    ASSERT_TRUE(frames && samples);
    for (std::size_t i = 0; i < frames->pixels.size(); ++i) {
        for (int shift = 0; shift < 24; shift += 8) {
            const auto a = static_cast<int>(frames->pixels[i] >> shift & 0xffu);
            const auto b = static_cast<int>(samples->pixels[i] >> shift & 0xffu);
            ASSERT_LE(std::abs(a - b), 2) << i;
        }
    }
}

TEST_F(PfviewCli, ACameraPathGivesNumberedPictures) {
    writeRoom("a.pf_vox");
    write(
        "path.json",
        R"({"cameras": [{"position": [3, 2, 20], "target": [3, 2, 0]}, {"position": [9, 5, 20], "target": [3, 2, 0]}]})");
    const std::string flight =
        "a.pf_vox --size 32x32 --samples 1 --screenshot f.png --frames 3 --camera-path ";
    const Outcome r = run(flight + "path.json");
    EXPECT_EQ(r.exitCode, 0) << r.err;
    EXPECT_EQ(
        run("a.pf_vox --size 32x32 --samples 1 --screenshot last.png --camera 9,5,20,3,2,0,40").exitCode, 0);
    EXPECT_EQ(contentOf(folder_ / "f-0003.png"), contentOf(folder_ / "last.png"));
    EXPECT_NE(contentOf(folder_ / "f-0001.png"), contentOf(folder_ / "f-0002.png"));
    EXPECT_FALSE(fs::exists(folder_ / "f-0004.png"));
    EXPECT_FALSE(fs::exists(folder_ / "f.png"));
    write("broken.json", R"({"cameras": [{"position": [3, 2], "target": [3, 2, 0]}]})");
    const Outcome broken = run(flight + "broken.json");
    EXPECT_EQ(broken.exitCode, 4);
    EXPECT_THAT(broken.err, HasSubstr("broken.json: camera 1: position is not three numbers"));
    EXPECT_EQ(run(flight + "none.json").exitCode, 3);
}

TEST_F(PfviewCli, AFolderShowsItsScene) {
    writeRoom("in/room.pf_vox");
    write("in/s.toml",
          "[[models]]\npath = 'room.pf_vox'\n[[models]]\npath = 'room.pf_vox'\ntranslateVec = [8, 0, 0]\n");
    const Outcome r = run("in --screenshot a.png --size 32x32 --samples 1 --stats-json -");
    EXPECT_EQ(r.exitCode, 0) << r.err;
    EXPECT_THAT(r.out, HasSubstr("\"instances\": 2,"));
}

TEST_F(PfviewCli, MissingFileUnwritablePictureAndUnknownDevice) {
    writeRoom("a.pf_vox");
    EXPECT_EQ(run("none.pf_vox --screenshot a.png").exitCode, 3);
    EXPECT_EQ(run("a.pf_vox --size 8x8 --screenshot /dev/null/a.png").exitCode, 3);
    const Outcome r = run("a.pf_vox --screenshot a.png --device 'no such device'");
    EXPECT_EQ(r.exitCode, 6);
    EXPECT_THAT(r.err, HasSubstr("there is: 0: "));
}

TEST_F(PfviewCli, TruncatedFileIsInvalidInput) {
    writeRoom("a.pf_vox");
    fs::resize_file(folder_ / "a.pf_vox", fs::file_size(folder_ / "a.pf_vox") / 2);
    const Outcome r = run("a.pf_vox --screenshot a.png");
    EXPECT_EQ(r.exitCode, 4);
    EXPECT_THAT(r.err, HasSubstr("a.pf_vox"));
    EXPECT_FALSE(fs::exists(folder_ / "a.png"));
}

TEST_F(PfviewCli, FailedRunKeepsTheOldPicture) {
    write("a.png", "old");
    EXPECT_EQ(run("none.pf_vox --screenshot a.png").exitCode, 3);
    EXPECT_EQ(contentOf(folder_ / "a.png"), "old");
}

TEST_F(PfviewCli, ListsDevices) {
    const Outcome r = run("--list-devices");
    EXPECT_EQ(r.exitCode, 0);
    EXPECT_THAT(r.out, StartsWith("0  "));
}

TEST_F(PfviewCli, ResultsThatCannotBeWrittenAreAFailure) {
    const Outcome r =
        run("--list-devices > /dev/full 2> err; exit $?; :");  // what run() appends is for the last word
    EXPECT_EQ(r.exitCode, 3);
    EXPECT_THAT(r.err, HasSubstr("standard output"));
}

}  // namespace
}  // namespace pfvox::test
