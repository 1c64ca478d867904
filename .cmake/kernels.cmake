# How kernels become words inside a target.

# compile_kernel(<source> <spv> <flag>...): compiles a .comp to SPIR-V, validates it and writes its words as <spv>.inc.
function(compile_kernel source spv)
  cmake_path(RELATIVE_PATH spv BASE_DIRECTORY ${PROJECT_BINARY_DIR} OUTPUT_VARIABLE shown)
  cmake_path(GET spv PARENT_PATH folder)
  file(MAKE_DIRECTORY ${folder})
  add_custom_command(
    OUTPUT ${spv}.inc
    COMMAND ${GLSLC} --target-env=vulkan1.2 -O -Werror -I ${PROJECT_SOURCE_DIR}/shaders ${ARGN}
            -MD -MF ${spv}.d -MT ${spv}.inc -o ${spv} ${source}
    COMMAND ${SPIRV_VAL} --target-env vulkan1.2 --scalar-block-layout ${spv}
    COMMAND ${CMAKE_COMMAND} -P ${PROJECT_SOURCE_DIR}/.cmake/words.cmake ${spv} ${spv}.inc
    DEPENDS ${source} ${PROJECT_SOURCE_DIR}/.cmake/words.cmake
    DEPFILE ${spv}.d
    COMMENT "Compiling ${shown}"
    VERBATIM)
endfunction()

# add_kernels(<target> <dir> <name>...): compiles <dir>/<name>.comp for <target>, which includes the words as
# "<name>.spv.inc". No file is looked up at run time.
function(add_kernels target dir)
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/kernels/${target})
  foreach(name ${ARGN})
    compile_kernel(${CMAKE_CURRENT_SOURCE_DIR}/${dir}/${name}.comp ${generated}/${name}.spv)
    target_sources(${target} PRIVATE ${generated}/${name}.spv.inc)
  endforeach()
  target_include_directories(${target} PRIVATE ${generated})
endfunction()

# add_kernel_table(<target>): the kernels of shaders/shared/kernels.h, those of modules `each` once an estimator of
# shaders/shared/estimators.h with its row as "estimator_row.glsl". <target> includes them as
# "kernel_words.inc", an array each, and "kernel_modules.inc", a MODULE(kernel, estimator, array) each.
function(add_kernel_table target)
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/kernels/${target})
  set(kernel_row "\n    ROW\\(([a-z0-9_]+), *[a-z_]+, *[a-z_]+, *(one|each),")
  set(estimator_row "\n    ROW\\(\"([a-z0-9-]+)\", *([a-z_]+), *(true|false),")
  foreach(table kernel estimator)
    set(file ${PROJECT_SOURCE_DIR}/shaders/shared/${table}s.h)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(READ ${file} text)
    string(REGEX MATCHALL "${${table}_row}" ${table}_rows "${text}")
  endforeach()
  set(estimators)
  foreach(row IN LISTS estimator_rows)
    string(REGEX MATCH "${estimator_row}" row "${row}")
    list(APPEND estimators ${CMAKE_MATCH_1})
    string(REPLACE - _ file ${CMAKE_MATCH_1})
    file(CONFIGURE OUTPUT ${generated}/${file}/estimator_row.glsl @ONLY CONTENT
"#define KEEPS KEEPS_${CMAKE_MATCH_2}
#define STATISTIC_${CMAKE_MATCH_2} 1
const bool FOLDED = ${CMAKE_MATCH_3};
#include \"estimators/${file}.glsl\"
")
  endforeach()
  set(arrays)
  set(modules)
  foreach(row IN LISTS kernel_rows)
    string(REGEX MATCH "${kernel_row}" row "${row}")
    set(kernel ${CMAKE_MATCH_1})
    set(estimators_of_kernel any)
    if(CMAKE_MATCH_2 STREQUAL each)
      set(estimators_of_kernel ${estimators})
    endif()
    foreach(estimator ${estimators_of_kernel})
      string(REPLACE - _ file ${estimator})
      compile_kernel(${PROJECT_SOURCE_DIR}/shaders/kernels/${kernel}.comp ${generated}/${file}/${kernel}.spv
                     -I ${generated}/${file})
      target_sources(${target} PRIVATE ${generated}/${file}/${kernel}.spv.inc)
      string(APPEND arrays
        "constexpr std::uint32_t ${file}_${kernel}[] = {\n#include \"${file}/${kernel}.spv.inc\"\n};\n")
      string(APPEND modules "MODULE(${kernel}, \"${estimator}\", ${file}_${kernel})\n")
    endforeach()
  endforeach()
  file(CONFIGURE OUTPUT ${generated}/kernel_words.inc @ONLY CONTENT "@arrays@")
  file(CONFIGURE OUTPUT ${generated}/kernel_modules.inc @ONLY CONTENT "@modules@")
  target_include_directories(${target} PRIVATE ${generated})
endfunction()
