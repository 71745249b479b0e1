# ergocast_messages(<target> <proto>): a library of the C++ that protoc makes from <proto>, a path
# below the source folder. It is a separate library, because protoc's code causes warnings, and in a
# unity build its Message would clash with ours. <target>_generated only makes the files.
find_package(Protobuf REQUIRED)

function(ergocast_messages target proto)
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/generated)
  string(REGEX REPLACE "\\.proto$" ".pb" stem ${generated}/${proto})
  file(MAKE_DIRECTORY ${generated})
  add_custom_command(
    OUTPUT ${stem}.cc ${stem}.h
    COMMAND protobuf::protoc -I ${CMAKE_SOURCE_DIR} --cpp_out=${generated} ${proto}
    DEPENDS ${CMAKE_SOURCE_DIR}/${proto}
    COMMENT "Generating C++ from ${proto}")
  add_library(${target} STATIC ${stem}.cc ${stem}.h)
  target_include_directories(${target} SYSTEM PUBLIC $<BUILD_INTERFACE:${generated}>)
  target_link_libraries(${target} PUBLIC protobuf::libprotobuf)
  set_target_properties(${target} PROPERTIES UNITY_BUILD OFF)
  add_custom_target(${target}_generated DEPENDS ${stem}.cc ${stem}.h)
  add_dependencies(generated ${target}_generated)
endfunction()
