# SPDX-License-Identifier: Apache-2.0
# altiplan_add_plugin(KIND NAME): the library altiplan_KIND_NAME from the *.cpp files beside the
# calling CMakeLists.txt, and its test from the *_test.cpp files there where tests are built.
# KIND: environment, constraint, planner, local_planner, smoother, tuner, objective or task.

set(ALTIPLAN_PLUGIN_EXPORTS ${CMAKE_CURRENT_LIST_DIR}/plugin_exports.map)
set(ALTIPLAN_PLUGIN_CHECKSUM ${CMAKE_CURRENT_LIST_DIR}/plugin_checksum.cpp)

# altiplan_plugin_library(TARGET): how a library of plugins is linked. One exported symbol; never
# unloaded; a checksum of what is loaded of it, filled in after linking. It needs only those of altiplan's
# libraries that it uses: what uses the SDK alone works with each version that declares the same.
function(altiplan_plugin_library target)
  target_link_libraries(${target} PRIVATE altiplan::sdk altiplan::kit altiplan::formats)
  set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${ALTIPLAN_PLUGIN_EXPORTS})
  target_link_options(${target} PRIVATE
    -Wl,--version-script=${ALTIPLAN_PLUGIN_EXPORTS} -Wl,-z,nodelete -Wl,--build-id
    -Wl,--as-needed)
  altiplan_add_checksum(${target})
endfunction()

function(altiplan_add_checksum target)
  target_sources(${target} PRIVATE ${ALTIPLAN_PLUGIN_CHECKSUM})
  add_custom_command(TARGET ${target} POST_BUILD
    COMMAND $<TARGET_FILE:altiplan::checksum> $<TARGET_FILE:${target}> VERBATIM)
  if(TARGET altiplan_checksum)  # in altiplan's own build
    add_dependencies(${target} altiplan_checksum)
  endif()
endfunction()

function(altiplan_add_plugin kind name)
  set(kinds environment constraint planner local_planner smoother tuner objective task)
  if(NOT kind IN_LIST kinds)
    message(FATAL_ERROR "altiplan_add_plugin: expected one of ${kinds}, found '${kind}'")
  endif()
  if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
  endif()
  set(target altiplan_${kind}_${name})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "_test\\.cpp$")
  add_library(${target} MODULE ${sources})
  # -ffp-contract=off comes with altiplan::sdk.
  altiplan_plugin_library(${target})
  set_target_properties(${target} PROPERTIES
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  # Out of tree all of a project's plugins end up in its build folder: `--plugin-path build`.
  if(NOT ALTIPLAN_PLUGIN_DIR)
    set(ALTIPLAN_PLUGIN_DIR ${CMAKE_BINARY_DIR})
  endif()
  set_target_properties(${target} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${ALTIPLAN_PLUGIN_DIR})
  # Where the altiplan that was found looks for its plugins, below its prefix.
  include(GNUInstallDirs)
  if(NOT ALTIPLAN_INSTALL_LIBDIR)
    set(ALTIPLAN_INSTALL_LIBDIR ${CMAKE_INSTALL_LIBDIR})
  endif()
  if(NOT ALTIPLAN_PLUGIN_COMPONENT)
    set(ALTIPLAN_PLUGIN_COMPONENT program)
  endif()
  install(TARGETS ${target} LIBRARY DESTINATION ${ALTIPLAN_INSTALL_LIBDIR}/altiplan/plugins
    COMPONENT ${ALTIPLAN_PLUGIN_COMPONENT})
  set_property(GLOBAL APPEND PROPERTY ALTIPLAN_PLUGINS ${target})
  file(GLOB tests CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*_test.cpp)
  if(BUILD_TESTING AND COMMAND altiplan_add_test AND tests)
    altiplan_add_test(${kind}s ${kind}_${name} ${tests})
  endif()
endfunction()
