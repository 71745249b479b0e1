# The bridge to ROS 2 with mock robots, on both implementations of DDS that Debian has.
if(NOT TARGET ergocast-ros2)
  add_test(NAME ros2_bridge
    COMMAND sh -c "echo 'cyclonedds-dev and cyclonedds-tools are not installed'; exit 77")
  set_tests_properties(ros2_bridge PROPERTIES LABELS process SKIP_RETURN_CODE 77)
  return()
endif()

add_executable(mock-robot-cyclone bridges/ros2/cyclone_port.cc bridges/ros2/mock_robot.cc)
target_link_libraries(mock-robot-cyclone PRIVATE
  ergocast_ros2_types nlohmann_json::nlohmann_json ergocast::warnings)
ergocast_test(NAME ros2_mission_tests LABELS process RUNS_PROGRAMS
  SOURCES bridges/ros2/mission_test.cc
  PROPERTIES FIXTURES_REQUIRED node_ros2)
if(TARGET ergocast_example_mujoco)
  add_executable(mujoco-robots bridges/ros2/cyclone_port.cc bridges/ros2/mujoco_robots.cc)
  target_link_libraries(mujoco-robots PRIVATE ergocast_example_mujoco ergocast::scenario
    ergocast_ros2_types nlohmann_json::nlohmann_json ergocast::warnings)
  target_sources(ros2_mission_tests PRIVATE bridges/ros2/office_test.cc)
  add_dependencies(ros2_mission_tests mujoco-robots)
endif()
add_test(NAME ros2_type_hashes COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/bridges/ros2/type_hashes_test.py)
set_tests_properties(ros2_type_hashes PROPERTIES LABELS process)
# It fetches a reader of ROS 2 messages.
add_test(NAME ros2_reference
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/bridges/ros2/reference/fetch ${CMAKE_BINARY_DIR}/node_ros2)
set_tests_properties(ros2_reference PROPERTIES LABELS process FIXTURES_SETUP node_ros2)
add_dependencies(ros2_mission_tests ergocast-ros2 mock-robot-cyclone)

find_program(FASTDDSGEN fastddsgen)
find_library(FASTRTPS_LIBRARY fastrtps)
find_library(FASTCDR_LIBRARY fastcdr)
if(FASTDDSGEN AND FASTRTPS_LIBRARY AND FASTCDR_LIBRARY)
  set(fast ${CMAKE_CURRENT_BINARY_DIR}/fast_dds)
  set(sources ${fast}/ros_types.cxx ${fast}/ros_typesPubSubTypes.cxx)
  file(MAKE_DIRECTORY ${fast})
  add_custom_command(
    OUTPUT ${sources} ${fast}/ros_types.h ${fast}/ros_typesPubSubTypes.h
    COMMAND ${FASTDDSGEN} -replace -t ${fast} -d ${fast} ${CMAKE_SOURCE_DIR}/bridges/ros2/ros_types.idl
    DEPENDS ${CMAKE_SOURCE_DIR}/bridges/ros2/ros_types.idl
    COMMENT "Generating C++ for Fast DDS from ros_types.idl" VERBATIM)
  add_library(fast_dds_types STATIC ${sources})
  set_target_properties(fast_dds_types PROPERTIES UNITY_BUILD OFF)
  target_include_directories(fast_dds_types SYSTEM PUBLIC ${fast})
  target_link_libraries(fast_dds_types PUBLIC ${FASTRTPS_LIBRARY} ${FASTCDR_LIBRARY})
  add_executable(mock-robot-fast bridges/ros2/fast_port.cc bridges/ros2/mock_robot.cc)
  target_link_libraries(mock-robot-fast PRIVATE
    fast_dds_types nlohmann_json::nlohmann_json ergocast::warnings)
  add_executable(fast-recorder bridges/ros2/fast_recorder.cc)
  target_link_libraries(fast-recorder PRIVATE
    fast_dds_types nlohmann_json::nlohmann_json ergocast::warnings)
  add_executable(fast-sender bridges/ros2/fast_sender.cc)
  target_link_libraries(fast-sender PRIVATE fast_dds_types ergocast::warnings)
  add_dependencies(ros2_mission_tests mock-robot-fast fast-recorder fast-sender)
  target_compile_definitions(ros2_mission_tests PRIVATE
    ERGOCAST_HAS_FAST_DDS ERGOCAST_NODE_ROS2="${CMAKE_BINARY_DIR}/node_ros2")
endif()
