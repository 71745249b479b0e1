# ergocast_commit: an object with the commit of this tree, for --version. A source archive has it in
# packaging/COMMIT. In a git tree it is written again when HEAD moves; changes that are not committed
# do not show. Without both it is empty.
file(READ ${CMAKE_SOURCE_DIR}/packaging/COMMIT commit)
string(STRIP "${commit}" commit)
set(COMMIT_SOURCE ${CMAKE_BINARY_DIR}/commit.cc)
set(moves)
if(commit MATCHES "^[0-9a-f]+$")
  string(SUBSTRING ${commit} 0 12 commit)
else()
  set(commit)
  find_program(GIT git)
  if(GIT)
    execute_process(COMMAND ${GIT} -C ${CMAKE_SOURCE_DIR} rev-parse --git-path logs/HEAD
      OUTPUT_VARIABLE moves OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  endif()
  if(moves)
    get_filename_component(moves ${moves} ABSOLUTE BASE_DIR ${CMAKE_SOURCE_DIR})
  endif()
endif()

if(moves AND EXISTS ${moves})
  add_custom_command(OUTPUT ${COMMIT_SOURCE}
    COMMAND ${CMAKE_COMMAND} -DGIT=${GIT} -DTREE=${CMAKE_SOURCE_DIR} -DSOURCE=${COMMIT_SOURCE}
      -P ${CMAKE_SOURCE_DIR}/cmake/write_commit.cmake
    DEPENDS ${moves} cmake/write_commit.cmake
    COMMENT "Writing the commit")
else()
  file(CONFIGURE OUTPUT ${COMMIT_SOURCE}
    CONTENT "extern \"C\" {\nextern const char ergocast_commit[];\nconst char ergocast_commit[] = \"${commit}\";\n}\n")
endif()
add_library(ergocast_commit OBJECT ${COMMIT_SOURCE})
