# SPDX-License-Identifier: Apache-2.0
# altiplan_add_assimp_plugin(KIND NAME): altiplan_add_plugin for a plugin that reads models, or a
# message where assimp is missing or off. The tests of the kind are built with its sources but NAME.cpp,
# and with assimp to write models.

option(ALTIPLAN_WITH_ASSIMP "Build the plugins that read models (assimp >= 5.2)" ON)
if(ALTIPLAN_WITH_ASSIMP)
  find_package(assimp 5.2 QUIET)
endif()

function(altiplan_add_assimp_plugin kind name)
  if(NOT ALTIPLAN_WITH_ASSIMP)
    message(STATUS "${kind} ${name}: off (ALTIPLAN_WITH_ASSIMP=OFF)")
    return()
  elseif(NOT TARGET assimp::assimp)
    message(STATUS "${kind} ${name}: off (no assimp >= 5.2 found; Debian: libassimp-dev)")
    return()
  endif()
  set(ALTIPLAN_PLUGIN_COMPONENT geo)
  altiplan_add_plugin(${kind} ${name})
  target_link_libraries(altiplan_${kind}_${name} PRIVATE assimp::assimp)
  if(TARGET test_${kind}s)
    file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
    list(FILTER sources EXCLUDE REGEX "(_test|/${name})\\.cpp$")
    target_sources(test_${kind}s PRIVATE ${sources})
    target_link_libraries(test_${kind}s PRIVATE assimp::assimp)
  endif()
endfunction()
