# Writes OUTPUT for CTest: a test for each GoogleTest suite in PROGRAM. A run of a suite is one process: a process for each
# of two thousand cases costs more than what most of them test.
#   NAME, PROGRAM, OUTPUT   the target, its file and where the tests go
#   LABELS                  of every suite, separated by commas
#   THREADS                 regular expression, may be empty: suites that get the labels threads and waits
cmake_minimum_required(VERSION 3.22)
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listing RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "${NAME} cannot list its tests: ${result}")
endif()
string(REGEX MATCHALL "(^|\n)[^ \n]+\\." suites "${listing}")
set(text "")
foreach(suite IN LISTS suites)
  string(STRIP "${suite}" suite)
  string(REGEX REPLACE "\\.$" "" suite "${suite}")
  string(REPLACE "," ";" labels "${LABELS}")
  if(THREADS AND suite MATCHES "${THREADS}")
    list(APPEND labels threads waits)
  endif()
  string(APPEND text
    "add_test([==[${suite}]==] [==[${PROGRAM}]==] [==[--gtest_filter=${suite}.*]==])\n"
    "set_tests_properties([==[${suite}]==] PROPERTIES LABELS [==[${labels}]==] TIMEOUT 600)\n")
endforeach()
file(WRITE ${OUTPUT} "${text}")
