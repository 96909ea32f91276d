#include <tiffio.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>

#include "flexura/picture/image_file.h"

namespace flexura {
namespace {

// A file in memory, with the file functions that libtiff calls.
struct MemoryFile {
  std::string bytes;
  std::size_t at = 0;
};

MemoryFile& file_of(thandle_t handle) { return *static_cast<MemoryFile*>(handle); }

tmsize_t read(thandle_t handle, void* data, tmsize_t size) {
  MemoryFile& file = file_of(handle);
  const std::size_t there = file.bytes.size() - std::min(file.at, file.bytes.size());
  const std::size_t count = std::min(static_cast<std::size_t>(size), there);
  std::memcpy(data, file.bytes.data() + file.bytes.size() - there, count);
  file.at += count;
  return static_cast<tmsize_t>(count);
}

tmsize_t write(thandle_t handle, void* data, tmsize_t size) {
  MemoryFile& file = file_of(handle);
  const auto count = static_cast<std::size_t>(size);
  file.bytes.resize(std::max(file.bytes.size(), file.at + count));
  std::memcpy(file.bytes.data() + file.at, data, count);
  file.at += count;
  return size;
}

toff_t seek(thandle_t handle, toff_t offset, int from) {
  MemoryFile& file = file_of(handle);
  if (from == SEEK_SET) file.at = offset;
  if (from == SEEK_CUR) file.at += offset;
  if (from == SEEK_END) file.at = file.bytes.size() + offset;
  return file.at;
}

int close(thandle_t /*handle*/) { return 0; }
toff_t size_of(thandle_t handle) { return file_of(handle).bytes.size(); }

using Tiff = std::unique_ptr<TIFF, decltype([](TIFF* open) { TIFFClose(open); })>;

}  // namespace

std::string tiff(const Image<float>& image) {
  if (image.width() <= 0 || image.height() <= 0 || image.channels() <= 0)
    throw std::invalid_argument("a TIFF file needs pixels");
  MemoryFile file;
  {
    const Tiff open(
        TIFFClientOpen("memory", "wm", &file, read, write, seek, close, size_of, nullptr, nullptr));
    if (!open) throw std::runtime_error("libtiff did not open a file in memory");
    const auto set = [&](std::uint32_t tag, auto value) { TIFFSetField(open.get(), tag, value); };
    set(TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(image.width()));
    set(TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(image.height()));
    set(TIFFTAG_SAMPLESPERPIXEL, image.channels());
    set(TIFFTAG_BITSPERSAMPLE, 32);
    set(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
    set(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    set(TIFFTAG_PHOTOMETRIC, image.channels() == 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
    set(TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
    set(TIFFTAG_ROWSPERSTRIP, TIFFDefaultStripSize(open.get(), 0));
    for (int v = 0; v < image.height(); ++v) {
      // libtiff takes a mutable row but does not modify it when writing.
      void* row = const_cast<float*>(image.row(v).data());
      if (TIFFWriteScanline(open.get(), row, static_cast<std::uint32_t>(v)) != 1)
        throw std::runtime_error("libtiff cannot write the image");
    }
  }
  return std::move(file.bytes);
}

}  // namespace flexura
