// GLib never frees its first table of names (16 KiB), which LeakSanitizer reports. Only the allocation's last
// call is known there, so this hides other leaks of g_malloc(), too: without this file there
// is exactly one.

// NOLINTNEXTLINE(readability-identifier-naming,bugprone-reserved-identifier): the sanitizer's name.
extern "C" const char* __lsan_default_suppressions() { return "leak:g_malloc\n"; }
