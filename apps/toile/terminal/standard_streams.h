#pragma once

namespace toile::app {

/// Makes writing safe for the rest of the program. Standard streams that are closed become /dev/null, so that
/// no file gets their numbers and with them their text. A write to a pipe without reader or beyond a limit of
/// file size fails, instead of ending the program by SIGPIPE or SIGXFSZ.
void secure_standard_streams();

/// Sends what is buffered for standard output. @return whether all of its text could be written
bool flush_standard_output();

} // namespace toile::app
