# Runs an entry of covering_seeds.txt: its seeds, and fresh ones that each commit draws again.
#   cmake -DERGOCAST=<program> -DSOURCE_DIR=<tree> -DENTRY=<name> -P trials.cmake
# With ERGOCAST_TRIALS=nightly in the environment it also runs the entry's nightly range, and 200
# fresh seeds. Seeds that fail are printed, so that they can be repeated.
file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/covering_seeds.txt entry REGEX "^${ENTRY} ")
if(NOT entry MATCHES "^[^ ]+ ([^ ]+) ([^ ]+) nightly=([0-9:]+) fresh=([0-9]+) kept=[0-9,]* seeds=([0-9,]+)$")
  message(FATAL_ERROR "covering_seeds.txt has no valid entry ${ENTRY}")
endif()
set(scenario ${CMAKE_MATCH_1})
set(pace ${CMAKE_MATCH_2})
set(nightly ${CMAKE_MATCH_3})
set(fresh ${CMAKE_MATCH_4})
string(REPLACE "," ";" seeds ${CMAKE_MATCH_5})
if("$ENV{ERGOCAST_TRIALS}" STREQUAL "nightly")
  list(APPEND seeds ${nightly})
  set(fresh 200)
elseif(NOT "$ENV{ERGOCAST_TRIALS}" STREQUAL "")
  message(FATAL_ERROR "ERGOCAST_TRIALS is $ENV{ERGOCAST_TRIALS}, but may only be nightly, or empty")
endif()

# Nothing in a tree without its history.
execute_process(COMMAND git -C ${SOURCE_DIR} rev-parse HEAD
  OUTPUT_VARIABLE commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
string(SHA1 digits "${commit} ${ENTRY}")  # each entry draws faults of its own
string(SUBSTRING ${digits} 0 7 digits)
math(EXPR first "0x${digits} + 1000000")
math(EXPR last "${first} + ${fresh} - 1")
list(APPEND seeds ${first}:${last})

foreach(range ${seeds})
  execute_process(
    COMMAND ${ERGOCAST} simulate ${SOURCE_DIR}/${scenario} ${pace} --faults swarm --seeds ${range} --jobs 1
    RESULT_VARIABLE code)
  if(NOT code EQUAL 0)
    list(APPEND failed "seeds ${range}: exit code ${code}")
  endif()
endforeach()
if(failed)
  list(JOIN failed "\n  " failed)
  message(FATAL_ERROR "${failed}")
endif()
