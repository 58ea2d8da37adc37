# SPDX-License-Identifier: Apache-2.0
# Flags and folders of the whole build. What changes the ABI or the arithmetic is set here only.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

# The build tree is laid out as the install tree: bin/altiplan, lib/, lib/altiplan/plugins/.
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
set(ALTIPLAN_PLUGIN_DIR ${CMAKE_BINARY_DIR}/lib/altiplan/plugins)
set(CMAKE_INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}" "$ORIGIN" "$ORIGIN/../..")

# What is installed belongs to one of the components program, library, geo, sdk, bench and python; a
# package is made of one or two, and none of python yet.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)

option(ALTIPLAN_PACKAGES "Debian packages by cpack (tools/package)" OFF)
option(ALTIPLAN_WERROR "Warnings are errors" ON)
option(ALTIPLAN_UNITY "Compile the files of a room, or of a plugin, as one unit: a third of the time" ON)
set(ALTIPLAN_SANITIZE "" CACHE STRING "Sanitizers, comma-separated (address,undefined or thread)")

add_library(altiplan_flags INTERFACE)
target_compile_options(altiplan_flags INTERFACE
  -ffp-contract=off
  -fno-math-errno  # roots by an instruction, also of vectors: the same numbers
  $<BUILD_INTERFACE:-Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion>
  # Files of one unit see each other's constants, and types of unnamed namespaces in included files.
  # Clang has no warning for locals alone.
  $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-Wshadow=local;-Wno-subobject-linkage>>
  $<BUILD_INTERFACE:$<$<NOT:$<OR:$<CXX_COMPILER_ID:GNU>,$<BOOL:${ALTIPLAN_UNITY}>>>:-Wshadow>>
  # Looking for garbage to collect below half a gigabyte takes g++ a fifteenth of its time.
  $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288>>
  # g++ 12 warns of std::string's own "text" + string (GCC bug 105651).
  $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>>
  $<BUILD_INTERFACE:$<$<BOOL:${ALTIPLAN_WERROR}>:-Werror>>)
install(TARGETS altiplan_flags EXPORT altiplan)
# altiplan_precompile(TARGET GROUP [HEADER…]): compiles what nearly every file includes once for all
# targets of the group, which have the same options; the first of them names more headers. GCC's alone
# are kept by ccache.
function(altiplan_precompile target group)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU" OR NOT CMAKE_BUILD_TYPE STREQUAL "Release")
    return()
  endif()
  # Precompiled, std::string is no system header to these warnings of g++ 12, which misread it.
  target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-stringop-overflow
    -Wno-stringop-overread)
  # Libraries would else differ in a macro, which GCC does not allow.
  set_target_properties(${target} PROPERTIES DEFINE_SYMBOL "")
  get_property(owner GLOBAL PROPERTY ALTIPLAN_PRECOMPILED_${group})
  if(owner)
    target_precompile_headers(${target} REUSE_FROM ${owner})
    return()
  endif()
  set_property(GLOBAL PROPERTY ALTIPLAN_PRECOMPILED_${group} ${target})
  target_precompile_headers(${target} PRIVATE <Eigen/Core> <algorithm> <chrono> <filesystem> <fstream>
    <functional> <map> <memory> <optional> <set> <sstream> <string> <thread> <vector> ${ARGN})
endfunction()

# altiplan_unite(TARGET [FILES]): compiles all files of the target as one unit, or FILES in each. What they
# include is parsed, and what they instantiate is made, once for each unit. Files with options of their
# own stay by themselves.
function(altiplan_unite target)
  set(files 0)
  if(ARGC GREATER 1)
    set(files ${ARGV1})
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${ALTIPLAN_UNITY}
    UNITY_BUILD_BATCH_SIZE ${files})
endfunction()

if(ALTIPLAN_SANITIZE)
  add_compile_options(-fsanitize=${ALTIPLAN_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  # GCC warns of what its own instrumentation leaves behind (std::function in <regex>).
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  add_link_options(-fsanitize=${ALTIPLAN_SANITIZE})
endif()
