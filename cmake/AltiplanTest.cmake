# SPDX-License-Identifier: Apache-2.0
# altiplan_add_test(NAME SOURCES…): a GoogleTest program, each of its cases a ctest.
# Suites whose name starts with Nightly carry the label nightly.

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
