# Compresses each file of FOLDER reproducibly and writes the source OUTPUT, which includes them with .incbin (a source
# with numbers takes seconds to compile). The names contain a hash of the content, so that caches do not confuse
# versions.
cmake_minimum_required(VERSION 3.25)
set(type_html "text/html; charset=utf-8")
set(type_js "text/javascript; charset=utf-8")
set(type_css "text/css; charset=utf-8")
set(type_json "application/json")
set(type_svg "image/svg+xml")
set(type_png "image/png")
set(type_ico "image/x-icon")
set(type_woff2 "font/woff2")

file(GLOB_RECURSE files RELATIVE ${FOLDER} ${FOLDER}/*)
list(SORT files)
if(NOT "index.html" IN_LIST files)
  message(FATAL_ERROR "There is no index.html in ${FOLDER}.")
endif()
file(GLOB old ${OUTPUT}.*.gz)
if(old)
  file(REMOVE ${old})
endif()
set(data "")
set(table "")
foreach(file ${files})
  cmake_path(GET file EXTENSION LAST_ONLY extension)
  string(SUBSTRING "${extension}" 1 -1 extension)
  if(NOT DEFINED type_${extension})
    message(FATAL_ERROR "${file}: cmake/EmbedPage.cmake knows no content type of a .${extension}.")
  endif()
  file(SHA256 ${FOLDER}/${file} hash)
  string(SUBSTRING ${hash} 0 16 hash)
  list(FIND files ${file} number)
  set(packed ${OUTPUT}.${number}.${hash}.gz)
  execute_process(COMMAND ${GZIP} -9nc ${FOLDER}/${file} OUTPUT_FILE ${packed} COMMAND_ERROR_IS_FATAL ANY)
  file(SIZE ${packed} size)
  set(symbol flexura_page_${number}_${hash})
  string(APPEND data "__asm__(\".section .rodata\\n${symbol}:\\n.incbin \\\"${packed}\\\"\\n.byte 0\\n.previous\");
extern \"C\" const std::uint8_t ${symbol}[${size}] __asm__(\"${symbol}\");\n")
  string(APPEND table "    {\"/${file}\", \"${type_${extension}}\", ${symbol}},\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"embedded/page.h\"
#include <cstdint>
${data}
namespace flexura::embedded {
namespace {
constexpr Asset assets[] = {
${table}};
}  // namespace
std::span<const Asset> page() { return assets; }
}  // namespace flexura::embedded
")
