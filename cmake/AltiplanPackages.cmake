# SPDX-License-Identifier: Apache-2.0
# Four Debian packages, which `cpack` makes in the build folder: altiplan, altiplan-dev,
# altiplan-plugins-geo for the plugins whose libraries are large, and python3-altiplan.

foreach(plugin IN ITEMS environment_terrain environment_mesh planner_ompl)
  if(NOT TARGET altiplan_${plugin})
    message(FATAL_ERROR
      "packages hold every plugin: ${plugin} is off, see above (tools/setup package)")
  endif()
endforeach()
if(NOT TARGET altiplan_python)
  message(FATAL_ERROR "packages hold the Python bindings: off, see above (tools/setup package)")
endif()
find_program(GZIP gzip REQUIRED)
find_program(HELP2MAN help2man REQUIRED)

function(altiplan_gzip input output)
  execute_process(COMMAND ${GZIP} -9nc ${input} OUTPUT_FILE ${output} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# Each package says what has changed and whose it is. SOURCE_DATE_EPOCH is honoured.
set(packages ${PROJECT_BINARY_DIR}/packages)
set(package_of_program altiplan)
set(package_of_sdk altiplan-dev)
set(package_of_geo altiplan-plugins-geo)
set(package_of_python python3-altiplan)
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(${CMAKE_CURRENT_LIST_DIR}/packages/changelog.in ${packages}/changelog @ONLY)
altiplan_gzip(${packages}/changelog ${packages}/changelog.Debian.gz)
altiplan_gzip(${PROJECT_SOURCE_DIR}/CHANGELOG.md ${packages}/changelog.gz)
foreach(component IN ITEMS program sdk geo python)
  set(folder ${CMAKE_INSTALL_DATADIR}/doc/${package_of_${component}})
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/packages/copyright ${packages}/changelog.Debian.gz
    ${packages}/changelog.gz DESTINATION ${folder} COMPONENT ${component})
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/packages/${package_of_${component}}.overrides
    DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides RENAME ${package_of_${component}}
    COMPONENT ${component})
endforeach()

# altiplan_man_page(TARGET COMPONENT SENTENCE): the page that `--help` makes.
function(altiplan_man_page target component sentence)
  set(page ${packages}/$<TARGET_FILE_NAME:${target}>.1.gz)
  add_custom_command(OUTPUT ${packages}/${target}.done
    COMMAND ${HELP2MAN} --no-info --name ${sentence} --version-string ${PROJECT_VERSION}
      $<TARGET_FILE:${target}> | ${GZIP} -9nc > ${page}
    COMMAND ${CMAKE_COMMAND} -E touch ${packages}/${target}.done
    DEPENDS ${target} VERBATIM)
  add_custom_target(${target}_man_page ALL DEPENDS ${packages}/${target}.done)
  install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component})
endfunction()
altiplan_man_page(altiplan_bench bench "runs published benchmarks of planners")

set(CPACK_GENERATOR DEB)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_PACKAGE_NAME altiplan)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "altiplan developers <altiplan@example.org>")
set(CPACK_PACKAGE_DIRECTORY ${packages})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each description begins with its own
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL program library sdk bench geo python)
set(CPACK_COMPONENT_PROGRAM_GROUP altiplan)
set(CPACK_COMPONENT_LIBRARY_GROUP altiplan)
set(CPACK_COMPONENT_SDK_GROUP dev)
set(CPACK_COMPONENT_BENCH_GROUP dev)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
set(same_version "(= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")

# What the package of libraries in a folder of the system's owes, which CPack writes for libraries
# with a version only.
file(WRITE ${packages}/triggers "activate-noawait ldconfig\n")
file(WRITE ${packages}/shlibs "")
foreach(library IN ITEMS altiplan altiplan_kit altiplan_formats)
  get_target_property(file ${library} OUTPUT_NAME)
  get_target_property(soversion ${library} SOVERSION)
  file(APPEND ${packages}/shlibs "lib${file} ${soversion} altiplan (>= ${PROJECT_VERSION})\n")
endforeach()

set(CPACK_DEBIAN_ALTIPLAN_PACKAGE_NAME altiplan)
set(CPACK_DEBIAN_ALTIPLAN_PACKAGE_CONTROL_EXTRA "${packages}/triggers;${packages}/shlibs")
set(CPACK_DEBIAN_ALTIPLAN_PACKAGE_SECTION science)
# PROJ is opened by the first file of buildings that names a coordinate system.
set(CPACK_DEBIAN_ALTIPLAN_PACKAGE_RECOMMENDS "altiplan-plugins-geo, libproj25, proj-data")
set(CPACK_DEBIAN_ALTIPLAN_PACKAGE_SUGGESTS "altiplan-dev, gdal-bin, librsvg2-bin")
set(CPACK_DEBIAN_ALTIPLAN_DESCRIPTION "planning of routes for unmanned aircraft
Routes over real terrain are planned, smoothed, flown in simulation, judged
exactly and compared in studies. Everything that varies is a plugin composed
in YAML: the layers of the world, the rules that a route keeps, planners,
smoothers and local planners.
.
This package holds the program, its libraries, and the plugins that need no
large library.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME altiplan-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "altiplan ${same_version}, libeigen3-dev (>= 3.4)")
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS
  "g++ (>= 4:12) | clang (>= 1:14), cmake (>= 3.25), make | ninja-build, libgtest-dev")
set(CPACK_DEBIAN_DEV_DESCRIPTION "planning of routes for unmanned aircraft: SDK for plugins
Headers, CMake files and the conformance suite for environments, constraints,
planners, local planners, smoothers and tuners of one's own. The command
'altiplan new' writes a project to begin with.
.
This package holds altiplan-bench too, which plans the scenarios of published
grid maps and times planners and pilots.")

include(AltiplanGdal)
# GDAL is opened at the first read, where no tool sees it; Debian names the package after it.
string(REGEX REPLACE "\\.so\\." "" gdal_package ${ALTIPLAN_GDAL_SONAME})
set(CPACK_DEBIAN_GEO_PACKAGE_NAME altiplan-plugins-geo)
set(CPACK_DEBIAN_GEO_PACKAGE_SECTION science)
set(CPACK_DEBIAN_GEO_PACKAGE_DEPENDS "altiplan ${same_version}, ${gdal_package}, proj-data")
set(CPACK_DEBIAN_GEO_DESCRIPTION "planning of routes for unmanned aircraft: geodata, models, OMPL
Plugins of altiplan that need large libraries: the environment 'terrain' reads
elevation models by GDAL, the environment 'mesh' reads models of solids by
assimp, and the planner 'ompl' runs those of the Open Motion Planning Library.")

# A module in C++ works with the version of Python that it was compiled for.
set(Python3_EXECUTABLE /usr/bin/python3)
find_package(Python3 REQUIRED COMPONENTS Interpreter)
math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-altiplan)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "altiplan ${same_version}, \
python3 (>= ${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}~), \
python3 (<< ${Python3_VERSION_MAJOR}.${next_minor}), python3:any, python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-matplotlib, python3-pandas")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
  "${CMAKE_CURRENT_LIST_DIR}/packages/postinst;${CMAKE_CURRENT_LIST_DIR}/packages/prerm")
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "planning of routes for unmanned aircraft: Python 3 package
The module altiplan runs pipelines and studies, plans and judges routes, and
queries worlds. Points go in and come out as arrays of numpy, and tables of a
study as those of pandas.")
include(CPack)
