# Writes INPUT into the header OUTPUT as the string_view flexura::embedded::SYMBOL (script mode).
file(READ ${INPUT} hex HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "\\\\x\\1" bytes "${hex}")
# Chunks of 64 bytes: short lines, and each literal ends before the next \x can swallow its digits.
string(REGEX REPLACE "((\\\\x[0-9a-f][0-9a-f])(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?)" "\"\\1\"\n" literal "${bytes}")
file(SIZE ${INPUT} size)
file(WRITE ${OUTPUT}
  "#pragma once\n#include <string_view>\nnamespace flexura::embedded {\n"
  "inline constexpr std::string_view ${SYMBOL}(\n${literal},\n${size});\n}  // namespace flexura::embedded\n")
