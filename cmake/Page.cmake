# Embeds the viewer's page into the program, so that it needs no files at run time.
option(FLEXURA_VIEWER "Build the viewer's page into the program (needs Node)" ON)

# flexura_embed_page(TARGET FOLDER [MADE_BY command...] [DEPENDS files...]) compresses the files of FOLDER into TARGET.
# The command generates them when one of `files` has changed. The sources of TARGET access them through the generated
# header "embedded/page.h" as flexura::embedded::page(), a table of Asset (flexura/serve/server.h).
function(flexura_embed_page target folder)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "MADE_BY;DEPENDS")
  find_program(GZIP gzip REQUIRED)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/embedded/page.cc)
  set(script ${PROJECT_SOURCE_DIR}/cmake/EmbedPage.cmake)
  set(commands)
  if(arg_MADE_BY)
    list(APPEND commands COMMAND ${arg_MADE_BY})
  endif()
  add_custom_command(OUTPUT ${source}
    ${commands}
    COMMAND ${CMAKE_COMMAND} -DFOLDER=${folder} -DOUTPUT=${source} -DGZIP=${GZIP} -P ${script}
    DEPENDS ${arg_DEPENDS} ${script} COMMENT "Embedding the page of ${target}" VERBATIM)
  flexura_page_source(${target} ${source})
  # A separate target, so that the page need not wait for the libraries of TARGET.
  add_custom_target(${target}_page DEPENDS ${source})
  add_dependencies(${target} ${target}_page)
endfunction()

# flexura_viewer_page(TARGET) embeds the page of viewer/, or an empty table with FLEXURA_VIEWER=OFF.
function(flexura_viewer_page target)
  if(NOT FLEXURA_VIEWER)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/embedded/no_page.cc)
    file(CONFIGURE OUTPUT ${source} CONTENT "#include \"embedded/page.h\"
std::span<const flexura::Asset> flexura::embedded::page() { return {}; }\n")
    flexura_page_source(${target} ${source})
    return()
  endif()
  set(viewer ${PROJECT_SOURCE_DIR}/viewer)
  find_program(NPM npm)
  if(NOT NPM OR NOT EXISTS ${viewer}/node_modules/vite/package.json)
    message(FATAL_ERROR "The viewer's page needs Node and its packages: run 'npm ci' in viewer/, or leave the page out "
                        "with -DFLEXURA_VIEWER=OFF.")
  endif()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${viewer}/src/* ${viewer}/public/*)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/page)
  flexura_embed_page(${target} ${folder}
    MADE_BY ${CMAKE_COMMAND} -E chdir ${viewer} ${NPM} run --silent build -- --outDir ${folder} --emptyOutDir
            --logLevel warn
    DEPENDS ${sources} ${viewer}/index.html ${viewer}/package-lock.json ${viewer}/tsconfig.json ${viewer}/vite.config.ts)
endfunction()

function(flexura_page_source target source)
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/embedded/page.h CONTENT "#pragma once
#include <span>
#include \"flexura/serve/server.h\"
namespace flexura::embedded {
/// The parts of the page; empty in a program that was built without.
std::span<const Asset> page();
}  // namespace flexura::embedded\n")
  target_sources(${target} PRIVATE ${source})
  # Compiled separately, so that the other sources are the same with and without the page.
  set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
endfunction()
