# Writes the text of INPUT to the header OUTPUT as the string_view flexura::embedded::SYMBOL, and its SHA-256
# (hexadecimal) as flexura::embedded::SYMBOL_sha256 (script mode).
file(READ ${INPUT} text)
file(SHA256 ${INPUT} sha256)
file(WRITE ${OUTPUT} "#pragma once
#include <string_view>
namespace flexura::embedded {
inline constexpr std::string_view ${SYMBOL}(R\"embedded(${text})embedded\");
inline constexpr std::string_view ${SYMBOL}_sha256(\"${sha256}\");
}  // namespace flexura::embedded
")
