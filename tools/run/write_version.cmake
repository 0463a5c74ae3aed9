# Run at every build (cmake -P): writes OUTPUT from INPUT with the state of the source tree.
# configure_file leaves an unchanged file alone, so nothing is compiled again without need.
execute_process(
  COMMAND git describe --always --dirty
  WORKING_DIRECTORY ${SOURCE_DIR}
  OUTPUT_VARIABLE HOOF_CODE
  OUTPUT_STRIP_TRAILING_WHITESPACE
  RESULT_VARIABLE status
  ERROR_QUIET)
if(NOT status STREQUAL "0" OR HOOF_CODE STREQUAL "")
  set(HOOF_CODE "unknown")
endif()
configure_file(${INPUT} ${OUTPUT} @ONLY)
