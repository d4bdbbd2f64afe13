// VirtualScreen: an X server without a screen (Xvfb), real key and mouse events (xdotool), and what the
// screen shows.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "picture.hpp"
#include "support/process.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {

/// The path of a program of the PATH; nothing when it is not installed.
inline std::optional<std::string> programPath(const std::string& name) {
    for (const char* folder : {"/usr/bin/", "/usr/local/bin/", "/bin/"}) {
        if (std::filesystem::exists(folder + name)) return folder + name;
    }
    return std::nullopt;
}

class VirtualScreen {
  public:
    VirtualScreen(const std::string& xvfb, std::string xdotool, std::uint32_t width, std::uint32_t height)
        : xdotool_(std::move(xdotool)) {
        const std::string size = std::to_string(width) + "x" + std::to_string(height) + "x24";
        // The server chooses a display that is free and writes its number down.
        const std::string number = (folder_ / "display").string();
        server_ = std::make_unique<Process>(std::vector<std::string>{
            "/bin/sh", "-c",
            "exec '" + xvfb + "' -displayfd 3 -screen 0 " + size + " -nolisten tcp -fbdir '" +
                folder_.path().string() + "' 3> '" + number + "'"});
        for (int i = 0; i < 200 && !readText(number).ends_with('\n'); ++i) pause(0.1);
        const std::string text = readText(number);
        if (text.ends_with('\n')) {
            display_ = ":" + text.substr(0, text.size() - 1);
        } else {
            stop();
        }
    }
    ~VirtualScreen() { stop(); }

    bool isThere() const { return server_ != nullptr; }
    std::string environment() const { return "DISPLAY=" + display_; }

    /// What follows `xdotool`: {"key", "3"}, {"mousemove", "10", "20"}.
    void send(std::vector<std::string> words) const {
        words.insert(words.begin(), xdotool_);
        const ProcessResult result = runProcess(std::move(words), {.environment = {environment()}});
        if (result.exitCode != 0) throw std::runtime_error("xdotool: " + result.err);
    }

    /// The screen as it is now: the XWD file that the server keeps.
    viewer::Picture picture() const {
        const std::string file = readText(folder_ / "Xvfb_screen0");
        const auto word = [&](std::size_t index) {
            std::uint32_t value = 0;
            for (std::size_t i = 0; i < 4; ++i)
                value = value << 8 | static_cast<std::uint8_t>(file.at(4 * index + i));
            return value;
        };
        viewer::Picture picture{.width = word(4), .height = word(5), .pixels = {}};
        const std::size_t begin = word(0) + std::size_t{12} * word(19);
        const std::size_t rowBytes = word(12);
        for (std::uint32_t y = 0; y < picture.height; ++y) {
            for (std::uint32_t x = 0; x < picture.width; ++x) {
                const std::size_t at = begin + y * rowBytes + std::size_t{4} * x;  // B, G, R, -
                const auto channel = [&](std::size_t i) {
                    return std::uint32_t{static_cast<std::uint8_t>(file.at(at + i))};
                };
                picture.pixels.push_back(channel(2) | channel(1) << 8 | channel(0) << 16 | 0xff000000u);
            }
        }
        return picture;
    }

    static void pause(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

  private:
    void stop() {
        if (!server_) return;
        server_->send(SIGTERM);
        server_->finish();
        server_.reset();
    }

    TempFolder folder_;
    std::string xdotool_;
    std::string display_;
    std::unique_ptr<Process> server_;
};

}  // namespace pfvox::test
