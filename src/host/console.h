// What a program asks of the terminal it runs in.
#pragma once
#include <cstdio>

namespace gpgp::host {

/// Whether a person reads along, as opposed to a file or a pipe.
bool isTerminal(std::FILE* stream);

} // namespace gpgp::host
