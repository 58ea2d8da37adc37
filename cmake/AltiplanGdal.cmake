# SPDX-License-Identifier: Apache-2.0
# altiplan_add_gdal_plugin(KIND NAME): altiplan_add_plugin for a plugin that reads geodata, or a
# message where GDAL is missing or off. The library is opened at the first read, not linked, because
# loading it takes longer than most runs: its file name is all that is built in. libtiff, which it
# needs too and which is small, is linked.

option(ALTIPLAN_WITH_GDAL "Build the plugins that read geodata (GDAL >= 3.4)" ON)
if(ALTIPLAN_WITH_GDAL)
  find_package(GDAL 3.4 QUIET)
  find_package(TIFF 4.5 QUIET)
  if(GDAL_FOUND AND TIFF_FOUND)
    execute_process(COMMAND ${CMAKE_READELF} -d ${GDAL_LIBRARY} OUTPUT_VARIABLE dynamic ERROR_QUIET)
    if(dynamic MATCHES "SONAME[^[]*\\[([^]]+)\\]")
      set(ALTIPLAN_GDAL_SONAME ${CMAKE_MATCH_1})
    endif()
  endif()
endif()

function(altiplan_add_gdal_plugin kind name)
  if(NOT ALTIPLAN_WITH_GDAL)
    message(STATUS "${kind} ${name}: off (ALTIPLAN_WITH_GDAL=OFF)")
    return()
  elseif(NOT ALTIPLAN_GDAL_SONAME)
    message(STATUS "${kind} ${name}: off (no GDAL >= 3.4 with libtiff >= 4.5 found; Debian: libgdal-dev, libtiff-dev)")
    return()
  endif()
  set(ALTIPLAN_PLUGIN_COMPONENT geo)
  altiplan_add_plugin(${kind} ${name})
  target_include_directories(altiplan_${kind}_${name} SYSTEM PRIVATE ${GDAL_INCLUDE_DIRS})
  target_compile_definitions(altiplan_${kind}_${name} PRIVATE
    ALTIPLAN_GDAL_SONAME="${ALTIPLAN_GDAL_SONAME}")
  target_link_libraries(altiplan_${kind}_${name} PRIVATE TIFF::TIFF ${CMAKE_DL_LIBS})
endfunction()
