// Interrupt: Ctrl-C and termination signals end a program with exit code 130 and no half-written file.
//
// A thread of its own waits for SIGINT, SIGTERM and SIGHUP, but for those that were ignored when the program
// started (nohup, jobs in the background). What is being written is given up (io::abandonOutputs): writers
// need no guard. Work that can stop in order holds an OrderlyStop; the second signal ends the program all the
// same.
#pragma once

namespace pfvox::tools {

/// To be called once, before any other thread starts. Throws std::system_error when no thread can be started.
void exitOnInterrupt();

/// Whether a signal has come.
bool isInterrupted();

/// While one lives, the first signal does not end the program: whoever holds it asks isInterrupted() and
/// comes to an end. The program then ends with the last of them.
class OrderlyStop {
  public:
    OrderlyStop();
    OrderlyStop(const OrderlyStop&) = delete;
    OrderlyStop& operator=(const OrderlyStop&) = delete;
    ~OrderlyStop();
};

}  // namespace pfvox::tools
