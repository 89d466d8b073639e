#include "host/console.h"

#ifdef _WIN32
#include <io.h>
#else
#include <unistd.h>
#endif

namespace gpgp::host {

#ifdef _WIN32
bool isTerminal(std::FILE* stream) { return _isatty(_fileno(stream)) != 0; }
#else
bool isTerminal(std::FILE* stream) { return isatty(fileno(stream)) != 0; }
#endif

} // namespace gpgp::host
