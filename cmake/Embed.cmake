# flexura_embed(TARGET FILE...) makes the text of each file available to TARGET as a string_view. For FILE "report.css"
# the generated header "embedded/report_css.h" declares flexura::embedded::report_css, and report_css_sha256 with the
# text's hash in hexadecimal. The target "embedded" only generates these headers, for tools that read the sources.
add_custom_target(embedded)

function(flexura_embed target)
  foreach(file ${ARGN})
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
    cmake_path(GET file FILENAME name)
    string(MAKE_C_IDENTIFIER ${name} symbol)
    string(TOLOWER ${symbol} symbol)
    set(header ${CMAKE_CURRENT_BINARY_DIR}/embedded/${symbol}.h)
    add_custom_command(OUTPUT ${header}
      COMMAND ${CMAKE_COMMAND} -DINPUT=${file} -DOUTPUT=${header} -DSYMBOL=${symbol}
              -P ${PROJECT_SOURCE_DIR}/cmake/EmbedFile.cmake
      DEPENDS ${file} ${PROJECT_SOURCE_DIR}/cmake/EmbedFile.cmake VERBATIM)
    list(APPEND headers ${header})
  endforeach()
  target_sources(${target} PRIVATE ${headers})
  add_custom_target(${target}_embedded DEPENDS ${headers})
  add_dependencies(embedded ${target}_embedded)
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
endfunction()

# flexura_embed_examples(TARGET) makes every examples/*/experiment.toml available to TARGET. The header
# "embedded/examples.h" declares flexura::embedded::examples, an array of {name, text} sorted by folder name.
function(flexura_embed_examples target)
  file(GLOB files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/examples/*/experiment.toml)
  list(SORT files)
  set(header ${CMAKE_CURRENT_BINARY_DIR}/embedded/examples.h)
  add_custom_command(OUTPUT ${header}
    COMMAND ${CMAKE_COMMAND} "-DINPUTS=${files}" -DOUTPUT=${header}
            -P ${PROJECT_SOURCE_DIR}/cmake/EmbedExamples.cmake
    DEPENDS ${files} ${PROJECT_SOURCE_DIR}/cmake/EmbedExamples.cmake VERBATIM)
  target_sources(${target} PRIVATE ${header})
  add_custom_target(${target}_embedded_examples DEPENDS ${header})
  add_dependencies(embedded ${target}_embedded_examples)
endfunction()
