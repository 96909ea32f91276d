# Compiles one source of a folder's kernels for each instruction set; math/simd_path.h selects one at run time. If the
# compiler does not support a set, its source is empty. (The asan and tsan presets omit the wide sets, which take
# minutes to compile with a sanitizer. All are compiled from one source. The scenes preset, which fuzzes the renderer
# and the picture readers, compiles them with AddressSanitizer.)
include(CheckCXXCompilerFlag)
check_cxx_compiler_flag("-mavx2" FLEXURA_HAS_AVX2)
set(FLEXURA_AVX512_OPTIONS -mavx512f -mavx512bw -mprefer-vector-width=512)
list(JOIN FLEXURA_AVX512_OPTIONS " " options)
check_cxx_compiler_flag("${options}" FLEXURA_HAS_AVX512)

# flexura_simd_sources(STEM) compiles STEM_baseline.cc, STEM_avx2.cc and STEM_avx512.cc of the current folder, each for
# its set. Without errno, sqrt is a single instruction for all lanes. No precompiled headers, because their inline
# functions must not be compiled for another set here.
function(flexura_simd_sources stem)
  set_source_files_properties(${stem}_baseline.cc ${stem}_avx2.cc ${stem}_avx512.cc PROPERTIES
    COMPILE_OPTIONS -fno-math-errno SKIP_PRECOMPILE_HEADERS ON)
  if(FLEXURA_HAS_AVX2)
    set_property(SOURCE ${stem}_avx2.cc APPEND PROPERTY COMPILE_OPTIONS -mavx2)
  endif()
  if(FLEXURA_HAS_AVX512)
    # GCC 12 warns about intentionally undefined vectors in its own header (GCC bug 105593).
    set_property(SOURCE ${stem}_avx512.cc APPEND PROPERTY COMPILE_OPTIONS
      ${FLEXURA_AVX512_OPTIONS} -Wno-uninitialized)
  endif()
endfunction()
