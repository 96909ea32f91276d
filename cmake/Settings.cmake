# Compiler settings shared by every target of the project.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

find_program(CCACHE ccache)
if(CCACHE)
  # ccache sees through precompiled headers only with the first two relaxations; by the others what one checkout has compiled
  # serves all.
  set(CMAKE_CXX_COMPILER_LAUNCHER
      ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros,locale CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}
      CCACHE_NOHASHDIR=true ${CCACHE})
endif()

add_library(flexura_settings INTERFACE)
target_compile_options(flexura_settings INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wnon-virtual-dtor -Werror
  # In a unity build a source may use a name that another one has for itself; the lint preset looks at each alone.
  -Wshadow$<$<BOOL:${CMAKE_UNITY_BUILD}>:=local>
  # The same bits from every code path: no fused multiply-add behind the code's back.
  -ffp-contract=off
  # At -O3 GCC 12 sees overlaps, overruns and unset members in std::string and std::shared_ptr that are not there
  # (GCC bugs 105651, 105329, 105562); AddressSanitizer looks for the real ones.
  "$<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-array-bounds;-Wno-stringop-overflow;-Wno-maybe-uninitialized>"
  # Less garbage is collected than GCC does by default: some 5 % less time, for a fifth more memory.
  $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1048576>
  # Joined sources leave it to the other presets, lint's among them, to check format texts: a twentieth of the time.
  $<$<AND:$<BOOL:${CMAKE_UNITY_BUILD}>,$<CXX_COMPILER_ID:GNU>>:-DFMT_CONSTEVAL=>
  # The stable_sort of libstdc++ 12 uses what it calls deprecated itself.
  $<$<CXX_COMPILER_ID:Clang>:-Wno-deprecated-declarations>
  # Tests name their files by the path within the project, wherever it lies: ccache knows them again.
  -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=
  $<$<BOOL:${CCACHE}>:$<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>>)
if(FLEXURA_SANITIZE)
  target_compile_options(flexura_settings INTERFACE
    -fsanitize=${FLEXURA_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  # A third of the time to compile goes into these two; AddressSanitizer sees the null pointers, and the fuzz preset, where
  # bytes are read, looks for both.
  target_compile_options(flexura_settings INTERFACE
    $<$<CXX_COMPILER_ID:GNU>:-fno-sanitize=null$<COMMA>alignment>)
  target_link_options(flexura_settings INTERFACE -fsanitize=${FLEXURA_SANITIZE})
endif()
