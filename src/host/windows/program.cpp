// What a program of ours is on Windows, so that it does there what it does elsewhere: arguments, file names and output
// in UTF-8, and standard streams without translation of line ends, as pictures and JSON go through them.
//
// The manifest beside this file (Windows 10 1903 and later) makes UTF-8 the code page of arguments and of names that
// the C library takes. Its console, and std::filesystem in libstdc++, have to be told apart from that.
#include <fcntl.h>
#include <io.h>

#include <cstddef>
#include <cstdio>
#include <initializer_list>

#define WIN32_LEAN_AND_MEAN
#include <windows.h>

namespace {

struct Streams {
  Streams() {
    for (std::FILE* stream : {stdin, stdout, stderr}) _setmode(_fileno(stream), _O_BINARY);
    SetConsoleOutputCP(CP_UTF8);
  }
};
const Streams streams;

} // namespace

#ifdef __MINGW32__
#include <cerrno>
#include <cwchar>

/// libstdc++ makes std::filesystem::path of char by mbrtowc in the C library's locale; msvcrt has none in UTF-8. The
/// linker puts this one in its place (--wrap): UTF-8 to UTF-16. Of a character outside the basic plane, three bytes
/// give the first surrogate, and the last byte gives the second, which the state holds until then.
extern "C" size_t __wrap_mbrtowc(wchar_t* to, const char* from, size_t size, std::mbstate_t* state) {
  static thread_local std::mbstate_t own = 0;
  if (!state) state = &own;
  if (!from) return *state = 0;
  if (size == 0) return static_cast<size_t>(-2);
  if (*state) {
    if (to) *to = static_cast<wchar_t>(*state);
    *state = 0;
    return 1;
  }
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(from[i]); };
  const auto invalid = [] {
    errno = EILSEQ;
    return static_cast<size_t>(-1);
  };
  const size_t length = byte(0) < 0x80   ? 1
                        : byte(0) < 0xc2 ? 0
                        : byte(0) < 0xe0 ? 2
                        : byte(0) < 0xf0 ? 3
                        : byte(0) < 0xf5 ? 4
                                         : 0;
  if (length == 0) return invalid();
  unsigned long character = length == 1 ? byte(0) : byte(0) & (0x7fu >> length);
  for (size_t i = 1; i < length; ++i) {
    if (i == size) return static_cast<size_t>(-2);
    if ((byte(i) & 0xc0) != 0x80) return invalid();
    character = character << 6 | (byte(i) & 0x3f);
  }
  constexpr unsigned long kFirst[] = {0, 0, 0x80, 0x800, 0x10000};
  if (character < kFirst[length] || character > 0x10ffff || (character >= 0xd800 && character < 0xe000))
    return invalid();
  if (length == 4) {
    *state = static_cast<std::mbstate_t>(0xdc00 + (character & 0x3ff));
    character = 0xd7c0 + (character >> 10);
  }
  if (to) *to = static_cast<wchar_t>(character);
  return character == 0 ? 0 : length == 4 ? 3 : length;
}
#endif
