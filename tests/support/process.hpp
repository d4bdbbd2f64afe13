// Process: runs a program as a child and captures what it says, for the tests of the command line tools.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

extern char** environ;

namespace pfvox::test {

struct ProcessResult {
    int exitCode = -1;  ///< 128 + signal when a signal ended it
    std::string out;
    std::string err;
};

struct ProcessSetup {
    std::vector<std::string> environment;  ///< further "NAME=value" entries
    std::string input;             ///< what the child reads on stdin; at most a pipe's buffer (64 KiB)
    std::filesystem::path folder;  ///< where it runs; empty = here
};

/// A child process. The constructor starts it; finish() waits for its end.
class Process {
  public:
    explicit Process(std::vector<std::string> command, const ProcessSetup& setup = {}) {
        std::array<int, 2> in{};
        if (::pipe2(in.data(), O_CLOEXEC) != 0 || ::pipe2(out_.data(), O_CLOEXEC) != 0 ||
            ::pipe2(err_.data(), O_CLOEXEC) != 0) {
            throw std::runtime_error("pipe");
        }
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&actions, out_[1], STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&actions, err_[1], STDERR_FILENO);
        if (!setup.folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, setup.folder.c_str());

        std::vector<char*> arguments = pointersTo(command);
        std::vector<std::string> environment = setup.environment;
        for (char** entry = environ; *entry != nullptr; ++entry) environment.emplace_back(*entry);
        std::vector<char*> variables = pointersTo(environment);
        // What the tests were started with says nothing about the child: in the background, SIGINT may be
        // ignored.
        sigset_t defaults;
        sigemptyset(&defaults);
        for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ}) sigaddset(&defaults, signal);
        posix_spawnattr_t attributes;
        posix_spawnattr_init(&attributes);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
        posix_spawnattr_setsigdefault(&attributes, &defaults);
        const int error =
            ::posix_spawn(&pid_, arguments[0], &actions, &attributes, arguments.data(), variables.data());
        posix_spawnattr_destroy(&attributes);
        posix_spawn_file_actions_destroy(&actions);
        for (const int end : {in[0], out_[1], err_[1]}) ::close(end);
        if (error != 0) throw std::runtime_error("cannot start " + command.front());
        if (::write(in[1], setup.input.data(), setup.input.size()) < 0)
            throw std::runtime_error("write to child");
        ::close(in[1]);
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    void send(int signal) const { ::kill(pid_, signal); }

    bool hasEnded() const {
        siginfo_t info{};
        return ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
               info.si_pid == pid_;
    }

    ProcessResult finish() {
        ProcessResult result;
        std::array<pollfd, 2> ends{{{out_[0], POLLIN, 0}, {err_[0], POLLIN, 0}}};
        std::array<std::string*, 2> texts{&result.out, &result.err};
        for (int open = 2; open > 0;) {
            ::poll(ends.data(), ends.size(), -1);
            for (std::size_t i = 0; i < ends.size(); ++i) {
                if (ends[i].fd < 0 || ends[i].revents == 0) continue;
                std::array<char, 4096> buffer{};
                const ssize_t n = ::read(ends[i].fd, buffer.data(), buffer.size());
                if (n > 0) {
                    texts[i]->append(buffer.data(), static_cast<std::size_t>(n));
                } else {
                    ::close(ends[i].fd);
                    ends[i].fd = -1;
                    --open;
                }
            }
        }
        int status = 0;
        ::waitpid(pid_, &status, 0);
        result.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        return result;
    }

  private:
    static std::vector<char*> pointersTo(std::vector<std::string>& texts) {
        std::vector<char*> pointers;
        for (std::string& text : texts) pointers.push_back(text.data());
        pointers.push_back(nullptr);
        return pointers;
    }

    pid_t pid_ = -1;
    std::array<int, 2> out_{};
    std::array<int, 2> err_{};
};

inline ProcessResult runProcess(std::vector<std::string> command, const ProcessSetup& setup = {}) {
    return Process(std::move(command), setup).finish();
}

}  // namespace pfvox::test
