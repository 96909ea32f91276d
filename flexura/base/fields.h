#pragma once

// Forward declarations for headers that declare tables of fields but do not use them. The header of a struct
// S declares `const Table<S>& fields_of(const S*)`. The struct's source and all code that reads or writes S
// include table.h.
namespace flexura {

struct Node;
struct Spec;
struct Type;
class Reader;
template <class S>
class Table;
template <class T>
struct Codec;

}  // namespace flexura
