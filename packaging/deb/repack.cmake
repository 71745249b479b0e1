# CPack runs this after it packed. With SOURCE_DATE_EPOCH each package is packed again by dpkg-deb, which
# gives later files that time, sorts them, and so makes equal bytes of equal files.
if(NOT DEFINED ENV{SOURCE_DATE_EPOCH})
  return()
endif()
foreach(package ${CPACK_PACKAGE_FILES})
  file(REMOVE_RECURSE ${package}.files)
  foreach(command "dpkg-deb;-R;${package};${package}.files"
      "dpkg-deb;--root-owner-group;--threads-max=1;-b;${package}.files;${package}")
    execute_process(COMMAND ${command} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
  file(REMOVE_RECURSE ${package}.files)
endforeach()
