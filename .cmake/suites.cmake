# Writes ctest's list of a GoogleTest program, one test a suite: cmake -D PROGRAM=... -D LIST=... -D RESULTS=...
# -D PROPERTIES=... -P suites.cmake. Not one a test: most take less time than to create a device and its layer.

execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE lines COMMAND_ERROR_IS_FATAL ANY)
# A suite is a line that begins at its first column and ends in a dot; of suites of types a comment follows.
string(REGEX MATCHALL "\n[^ \n]+\\.( [^\n]*)?\n" suites "\n${lines}")
set(list "")
foreach(suite IN LISTS suites)
  string(REGEX REPLACE "^\n([^ \n]+)\\..*" "\\1" suite "${suite}")
  string(REPLACE "/" "." file "${suite}")
  string(APPEND list
    "add_test([=[${suite}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=] "
    "[=[--gtest_output=xml:${RESULTS}/${file}.xml]=])\n"
    "set_tests_properties([=[${suite}]=] PROPERTIES ${PROPERTIES})\n")
endforeach()
file(WRITE ${LIST} "${list}")
