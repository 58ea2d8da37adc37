# SPDX-License-Identifier: Apache-2.0
# altiplan_add_ompl_plugin(KIND NAME): altiplan_add_plugin for a plugin that runs OMPL's planners, or
# a message where OMPL is missing or off.

option(ALTIPLAN_WITH_OMPL "Build the plugins that run OMPL's planners (OMPL >= 1.5.2)" ON)
if(ALTIPLAN_WITH_OMPL)
  find_package(ompl 1.5.2 QUIET)
endif()

function(altiplan_add_ompl_plugin kind name)
  if(NOT ALTIPLAN_WITH_OMPL)
    message(STATUS "${kind} ${name}: off (ALTIPLAN_WITH_OMPL=OFF)")
    return()
  elseif(NOT ompl_FOUND)
    message(STATUS "${kind} ${name}: off (no OMPL >= 1.5.2 found; Debian: libompl-dev)")
    return()
  endif()
  set(ALTIPLAN_PLUGIN_COMPONENT geo)
  altiplan_add_plugin(${kind} ${name})
  list(GET OMPL_LIBRARIES 0 library)  # the others are for what is not used here
  target_include_directories(altiplan_${kind}_${name} SYSTEM PRIVATE ${OMPL_INCLUDE_DIRS})
  target_link_libraries(altiplan_${kind}_${name} PRIVATE ${library})
endfunction()
