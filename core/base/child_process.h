#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace toile {

/// Bounds of a child process.
struct ChildBounds {
    std::chrono::milliseconds time;
    std::size_t memory; ///< beyond what this process has mapped [bytes]
};

/// End of a child process before its work was done. The message continues a sentence about the work: "stopped
/// with SIGABRT".
class ChildStopped : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Returns what `work` returns in a child process, which may crash, loop or run out of memory and leaves this
/// process as it is. The child has no standard streams, dumps no core and ends with the calling thread. Of
/// the threads it has only this one: `work` must wait for no other.
/// @throws InvalidInput as `work` does
/// @throws ChildStopped if a signal ends the child, or a bound
/// @throws Cancelled    if Cancellation says so meanwhile
/// @throws DeviceError  if no process can be started
std::string in_child_process(const std::function<std::string()>& work, const ChildBounds& bounds);

/// End of a program that ended by itself.
struct ProgramEnd {
    int exit_code = 0;  ///< 127: it could not be started
    std::string output; ///< standard output
};

/// Runs another program as a child process, with the same bounds and the same end if this thread ends. It has
/// no input and no error stream.
/// @param command  name in PATH, or path, and the arguments
/// @throws ChildStopped, Cancelled, DeviceError as in_child_process
ProgramEnd run_program(const std::vector<std::string>& command, const ChildBounds& bounds);

} // namespace toile
