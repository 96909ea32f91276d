#include "flexura/picture/tiff_input.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <new>

#include "flexura/picture/picture_kinds.h"

namespace flexura {
namespace {

tmsize_t read_input(thandle_t handle, void* data, tmsize_t size) {
  auto* input = static_cast<TiffInput*>(handle);
  const std::uint64_t begin = std::min<std::uint64_t>(input->at, input->bytes.size());
  const std::uint64_t count =
      std::min<std::uint64_t>(static_cast<std::uint64_t>(size), input->bytes.size() - begin);
  if (count < static_cast<std::uint64_t>(size)) input->is_cut_short = true;
  if (count > 0) std::memcpy(data, input->bytes.data() + begin, count);
  input->at += count;
  return static_cast<tmsize_t>(count);
}

tmsize_t write_nowhere(thandle_t /*handle*/, void* /*data*/, tmsize_t /*size*/) { return 0; }

toff_t seek_input(thandle_t handle, toff_t offset, int from) {
  auto* input = static_cast<TiffInput*>(handle);
  if (from == SEEK_SET) input->at = offset;
  if (from == SEEK_CUR) input->at += offset;
  if (from == SEEK_END) input->at = input->bytes.size() + offset;
  return input->at;
}

int close_input(thandle_t /*handle*/) { return 0; }
toff_t input_size(thandle_t handle) { return static_cast<TiffInput*>(handle)->bytes.size(); }

// Keeps the first error, because later errors are consequences. A nonzero result suppresses libtiff's own
// handlers, which print.
int note_error(TIFF* /*open*/, void* user, const char* /*where*/, const char* format, va_list values) {
  auto* input = static_cast<TiffInput*>(user);
  if (input->text[0] == '\0') std::vsnprintf(input->text, sizeof input->text, format, values);
  return 1;
}

int pass_warning(TIFF* /*open*/, void* /*user*/, const char* /*where*/, const char* /*format*/,
                 va_list /*values*/) {
  return 1;
}

}  // namespace

std::runtime_error TiffInput::problem() const {
  return is_cut_short ? cut_short("TIFF") : damaged("TIFF", text);
}

OpenTiff open_tiff(TiffInput* input, std::size_t most_bytes) {
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                                 &TIFFOpenOptionsFree);
  if (!options) throw std::bad_alloc();
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), static_cast<tmsize_t>(most_bytes));
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), note_error, input);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), pass_warning, input);
  // m: not memory-mapped, r: reading functions only.
  OpenTiff open(TIFFClientOpenExt("memory", "rm", input, read_input, write_nowhere, seek_input, close_input,
                                  input_size, nullptr, nullptr, options.get()));
  if (!open) throw input->problem();
  return open;
}

}  // namespace flexura
