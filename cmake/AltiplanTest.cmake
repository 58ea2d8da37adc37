# SPDX-License-Identifier: Apache-2.0
# altiplan_add_test(PROGRAM NAME SOURCES…): the suites of SOURCES as the test NAME, which runs them alone
# in the GoogleTest program test_PROGRAM; the files of a program are compiled as units. A test is labelled
# quick unless it is among these, which take more than two seconds. Suites whose name starts with Nightly
# are a test of their own, labelled nightly.
set(ALTIPLAN_SLOW_TESTS
  environment_terrain framework_body_turns framework_many_corners framework_obstacle_tree
  framework_shape framework_swept_volume host_report host_watchdog host_worker_pool_limits
  host_worker_pool_parent host_yaml local_planner_velocity_field pipelines_every_pipeline
  pipelines_fusion_flights planner_anya planner_dstar_lite
  planner_lazy_theta_star planner_ompl planner_stratified_theta planner_taut reference_colony_oracle
  reference_earth reference_random_colonies reference_zone_maps)

function(altiplan_test_program program)
  set(target test_${program})
  if(TARGET ${target})
    return()
  endif()
  add_executable(${target})
  target_link_libraries(${target} PRIVATE altiplan_test_support)
  # What is tested is built as it is shipped; the tests need not be, and this is a third quicker.
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  altiplan_precompile(${target} tests <gtest/gtest.h>)
  altiplan_unite(${target} 10)
  set_target_properties(${target} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  set_property(GLOBAL APPEND PROPERTY ALTIPLAN_TEST_PROGRAMS ${target})
endfunction()

function(altiplan_add_test program name)
  altiplan_test_program(${program})
  target_sources(test_${program} PRIVATE ${ARGN})
  # Read again when a file changes: a suite that no test names would not be run.
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${ARGN})
  set(suites_day)
  set(suites_nightly)
  foreach(source IN LISTS ARGN)
    file(STRINGS ${source} cases REGEX "^TEST(_F|_P)?\\(")
    foreach(case IN LISTS cases)
      if(NOT case MATCHES "^TEST(_F|_P)?\\(([A-Za-z0-9_]+)")
        continue()
      endif()
      set(macro TEST${CMAKE_MATCH_1})
      set(suite ${CMAKE_MATCH_2})
      get_property(owner GLOBAL PROPERTY ALTIPLAN_SUITE_${program}_${suite})
      if(owner AND NOT owner STREQUAL name)
        message(FATAL_ERROR "${source}: the suite ${suite} is that of the test ${owner}, too")
      endif()
      set_property(GLOBAL PROPERTY ALTIPLAN_SUITE_${program}_${suite} ${name})
      set(kind day)
      if(suite MATCHES "^Nightly")
        set(kind nightly)
      endif()
      if(macro STREQUAL "TEST_P")
        set(suite */${suite})
      endif()
      list(APPEND suites_${kind} ${suite}.*)
    endforeach()
  endforeach()
  foreach(kind IN ITEMS day nightly)
    list(REMOVE_DUPLICATES suites_${kind})
    list(JOIN suites_${kind} : filter_${kind})
  endforeach()
  if(suites_day)
    add_test(NAME ${name} COMMAND test_${program} --gtest_filter=${filter_day})
    set_tests_properties(${name} PROPERTIES TIMEOUT 300)
    if(NOT name IN_LIST ALTIPLAN_SLOW_TESTS)
      set_tests_properties(${name} PROPERTIES LABELS quick)
    endif()
  endif()
  if(suites_nightly)
    add_test(NAME ${name}_nightly COMMAND test_${program} --gtest_filter=${filter_nightly})
    set_tests_properties(${name}_nightly PROPERTIES LABELS nightly TIMEOUT 7200)
  endif()
endfunction()

# altiplan_add_python_test(NAME FILE ARGUMENT…): FILE as the test NAME; where it leaves something to the night
# (tests/support/night.py), NAME_nightly is all of it. Exit code 77: it cannot run here.
function(altiplan_add_python_test name file)
  altiplan_add_day_and_night(${name} ${file} /usr/bin/python3 ${file} ${ARGN})
endfunction()

# altiplan_add_day_and_night(NAME FILE COMMAND…): the same with a command that runs FILE.
function(altiplan_add_day_and_night name file)
  add_test(NAME ${name} COMMAND ${ARGN})
  set_tests_properties(${name} PROPERTIES TIMEOUT 900 SKIP_RETURN_CODE 77)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(STRINGS ${file} left_to_the_night REGEX "NIGHTLY|@by_night|by_day")
  if(left_to_the_night)
    set_tests_properties(${name} PROPERTIES COST 10)  # among the first: it takes long by day, too
    add_test(NAME ${name}_nightly COMMAND ${ARGN})
    set_tests_properties(${name}_nightly PROPERTIES TIMEOUT 3600 SKIP_RETURN_CODE 77 LABELS nightly
      ENVIRONMENT ALTIPLAN_NIGHTLY=1)
  endif()
endfunction()
