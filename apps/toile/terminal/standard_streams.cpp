#include "apps/toile/terminal/standard_streams.h"

#include <csignal>
#include <iostream>

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

namespace toile::app {

void secure_standard_streams()
{
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
        if (::fcntl(stream, F_GETFD) < 0)
            ::open("/dev/null", O_RDWR); // the lowest free number is that of the stream
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGCHLD,
                SIG_DFL); // whoever started the program may have ignored it: no child could be waited for
}

bool flush_standard_output() { return bool(std::cout << std::flush); }

} // namespace toile::app
