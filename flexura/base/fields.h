#pragma once

// Forward declarations of table.h, for headers that declare tables of fields without using them. A struct's
// header declares `const Table<S>& fields_of(const S*)`; its source and all readers and writers include
// table.h.
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
