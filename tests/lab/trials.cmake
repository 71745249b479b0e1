# Flies `SEEDS` fixed seeds of a faulty team, and 200 more that each commit draws anew:
#   cmake -DERGOCAST=<program> -DSOURCE_DIR=<tree> -DSCENARIO=<file> -DSEEDS=1:2000 -DPACE=--realtime -P trials.cmake
# The second range is printed with the failures, so that it can be flown again.
execute_process(COMMAND git -C ${SOURCE_DIR} rev-parse HEAD
  OUTPUT_VARIABLE commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
if(NOT commit MATCHES "^[0-9a-f]+$")
  set(commit 0000000)  # a tree without its history
endif()
string(SUBSTRING ${commit} 0 7 digits)
math(EXPR first "0x${digits} + 1000000")
math(EXPR last "${first} + 199")
foreach(seeds ${SEEDS} ${first}:${last})
  execute_process(
    COMMAND ${ERGOCAST} simulate ${SOURCE_DIR}/${SCENARIO}
      ${PACE} --faults swarm --seeds ${seeds} --jobs 2
    RESULT_VARIABLE code)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "seeds ${seeds}: exit code ${code}")
  endif()
endforeach()
