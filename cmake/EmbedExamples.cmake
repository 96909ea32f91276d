# Writes the contents of INPUTS, files examples/NAME/experiment.toml, to the header OUTPUT (script mode).
set(entries "")
foreach(input ${INPUTS})
  file(READ ${input} text)
  cmake_path(GET input PARENT_PATH folder)
  cmake_path(GET folder FILENAME name)
  string(APPEND entries "    {\"${name}\", R\"embedded(${text})embedded\"},\n")
endforeach()
list(LENGTH INPUTS count)
file(WRITE ${OUTPUT} "#pragma once
#include <array>
#include <string_view>
namespace flexura::embedded {
struct Example {
  std::string_view name;
  std::string_view text;
};
inline constexpr std::array<Example, ${count}> examples{{
${entries}}};
}  // namespace flexura::embedded
")
