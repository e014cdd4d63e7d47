# How Qt Test suites are built and run: see support/qt/qt_suite.h.
find_package(Qt5 5.15 REQUIRED COMPONENTS Test Widgets)
find_program(XVFB_RUN xvfb-run)
if(NOT XVFB_RUN)
  # Building the application does not need it; a test run without it must not pass for whole.
  set(XVFB_RUN xvfb-run-is-missing)
  message(STATUS "GUI tests will fail: xvfb-run is missing (package xvfb)")
endif()
set(xvfb_run ${XVFB_RUN} -a -s "-screen 0 1600x1000x24")
set(xvfb_environment "QT_QPA_PLATFORM=xcb;LIBGL_ALWAYS_SOFTWARE=1")

# The headers of Qt Test programs, parsed once for all of them.
add_library(nearfit_qt_test_headers OBJECT support/qt/qt_suite.cpp)
target_link_libraries(nearfit_qt_test_headers PUBLIC nearfit_test_flags nearfit_test_support Qt5::Test Qt5::Widgets)
nearfit_precompile(nearfit_qt_test_headers <QtTest> <QtWidgets>)

# nearfit_add_qt_program(NAME FILES files... [LIBS libraries...])
# A program that holds the suites of the files.
function(nearfit_add_qt_program name)
  cmake_parse_arguments(arg "" "" "FILES;LIBS" ${ARGN})
  add_executable(${name} ${arg_FILES} $<TARGET_OBJECTS:nearfit_qt_test_headers> ${no_user_cache})
  target_link_libraries(${name} PRIVATE nearfit_test_flags nearfit_test_support nearfit_exact_oracle Qt5::Test ${arg_LIBS})
  # Most of what a file takes is parsing VTK's and our own headers: eight files take little longer than one. Which eight is
  # said here: versions of CMake count Qt's generated files differently, and local names differ among the eight alone.
  set(count 0)
  foreach(file IN LISTS arg_FILES)
    math(EXPR group "${count} / 8")
    set_source_files_properties(${file} PROPERTIES UNITY_GROUP ${name}_${group})
    math(EXPR count "${count} + 1")
  endforeach()
  set_target_properties(${name} PROPERTIES AUTOMOC ON UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  if(NEARFIT_PRECOMPILE)
    target_precompile_headers(${name} REUSE_FROM nearfit_qt_test_headers)
  endif()
endfunction()

# nearfit_add_qt_suite(PROGRAM LABEL SUITE [COMMAND...]): a test; what runs the program under the display comes first in COMMAND.
function(nearfit_add_qt_suite program label suite)
  add_test(NAME ${suite} COMMAND ${xvfb_run} ${ARGN} $<TARGET_FILE:${program}> ${suite})
  set_tests_properties(${suite} PROPERTIES LABELS "${label};waits" TIMEOUT 300 ENVIRONMENT "${xvfb_environment}")
endfunction()
