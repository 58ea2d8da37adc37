# SPDX-License-Identifier: Apache-2.0
# find_package(altiplan): the target altiplan::sdk and the function altiplan_add_plugin(KIND NAME).
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(Threads)
include(${CMAKE_CURRENT_LIST_DIR}/altiplan-targets.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/AltiplanPlugin.cmake)
