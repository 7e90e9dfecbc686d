// Standard input and output as bytes for other programs; posix/ and win32/ have one each.
#pragma once

namespace mien::app {

// At the start of the program: bytes pass unchanged, text is UTF-8, and a reader that goes away
// makes writes fail rather than end the program.
void prepare_standard_streams();

// Whether that is why the last write to standard output failed.
[[nodiscard]] bool reader_has_gone();

// Makes as little as possible wait in a pipe between us and a reader.
void shorten_standard_output();
// Whether a line can be written without waiting for the reader.
[[nodiscard]] bool standard_output_has_room();

}  // namespace mien::app
