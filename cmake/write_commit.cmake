# Writes the commit of TREE's HEAD into SOURCE.
execute_process(COMMAND ${GIT} -C ${TREE} rev-parse --short=12 HEAD
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
file(WRITE ${SOURCE} "extern \"C\" {\nextern const char ergocast_commit[];\nconst char ergocast_commit[] = \"${commit}\";\n}\n")
