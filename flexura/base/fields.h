#pragma once

// Names of what table.h defines, for headers that declare tables of fields without using them: a struct's
// header declares `const Table<S>& fields_of(const S*)`, its source and whoever reads or writes it include
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
