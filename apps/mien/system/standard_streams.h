// Standard input and output as byte streams. posix/ and win32/ have one implementation each.
#pragma once

namespace mien::app {

// Must be called at the start: bytes pass unchanged, text is UTF-8, and writing to a closed pipe
// fails instead of ending the program.
void prepare_standard_streams();

// Whether the last write to standard output failed because the reader closed the pipe.
[[nodiscard]] bool reader_has_closed();

// Minimizes the buffer of the pipe to the reader, for latency.
void shorten_standard_output();
// Whether a line can be written without waiting for the reader.
[[nodiscard]] bool standard_output_is_writable();

}  // namespace mien::app
