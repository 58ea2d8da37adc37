# SPDX-License-Identifier: Apache-2.0
# altiplan_add_test(NAME SOURCES…): a GoogleTest program, as one test. It is labelled quick unless it is
# among these, which take more than two seconds. Suites whose name starts with Nightly are a test of their
# own, labelled nightly.
set(ALTIPLAN_SLOW_TESTS
  environment_terrain framework_body_turns framework_many_corners framework_obstacle_tree
  framework_shape framework_swept_volume host_report host_watchdog host_worker_pool_limits
  host_worker_pool_parent host_yaml local_planner_velocity_field pipelines_every_pipeline
  pipelines_fusion_flights pipelines_profiles planner_anya planner_dstar_lite
  planner_lazy_theta_star planner_ompl planner_stratified_theta reference_colony_oracle
  reference_random_colonies reference_zone_maps)

function(altiplan_add_test name)
  add_executable(test_${name} ${ARGN})
  target_link_libraries(test_${name} PRIVATE altiplan_test_support)
  # What is tested is built as it is shipped; the tests need not be, and this is a third quicker.
  target_compile_options(test_${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  altiplan_precompile(test_${name} tests <gtest/gtest.h>)
  set_target_properties(test_${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  add_test(NAME ${name} COMMAND test_${name} --gtest_filter=-Nightly*:-*/Nightly*)
  set_tests_properties(${name} PROPERTIES TIMEOUT 300)
  if(NOT name IN_LIST ALTIPLAN_SLOW_TESTS)
    set_tests_properties(${name} PROPERTIES LABELS quick)
  endif()
  set(nightly)
  foreach(source IN LISTS ARGN)
    file(STRINGS ${source} cases REGEX "^TEST(_F|_P)?\\(Nightly")
    list(APPEND nightly ${cases})
  endforeach()
  if(nightly)
    add_test(NAME ${name}_nightly COMMAND test_${name} --gtest_filter=Nightly*:*/Nightly*)
    set_tests_properties(${name}_nightly PROPERTIES LABELS nightly TIMEOUT 7200)
  endif()
endfunction()
