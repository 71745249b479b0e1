# The libraries for other programs, which libergocast-dev installs (find_package(Ergocast)).
include(GNUInstallDirs)
if(CMAKE_LIBRARY_ARCHITECTURE)
  set(ERGOCAST_LIBDIR lib/${CMAKE_LIBRARY_ARCHITECTURE})
else()
  set(ERGOCAST_LIBDIR ${CMAKE_INSTALL_LIBDIR})
endif()
set(ERGOCAST_CMAKEDIR ${ERGOCAST_LIBDIR}/cmake/Ergocast)

# A program with ergocast_agent also needs messages as bytes.
add_library(ergocast_agent_and_codec INTERFACE)
target_link_libraries(ergocast_agent_and_codec INTERFACE ergocast_agent ergocast_codec)
# One with laws of its own also needs scenarios, and missions in one process.
add_library(ergocast_simulation INTERFACE)
target_link_libraries(ergocast_simulation INTERFACE ergocast_study_run ergocast_scenario)
set(SIMULATION ergocast_coordinator ergocast_geo ergocast_lab ergocast_logger ergocast_scenario
  ergocast_scenario_messages ergocast_sim ergocast_study_run)
set(INSTALLED ergocast_text ergocast_core ergocast_modes ergocast_plan ergocast_target ergocast_team ergocast_codec ergocast_agent)

# They may be linked into a shared library, such as a robot's plug-in or a Python module.
set(SHAREABLE ${INSTALLED} ergocast_coordinator ergocast_event_log ergocast_geo ergocast_lab ergocast_logger
  ergocast_report ergocast_run_directory ergocast_runtime ergocast_scenario ergocast_scenario_messages ergocast_sim ergocast_study_run
  ergocast_team_view ergocast_team_page ergocast_web_page)
foreach(library ${SHAREABLE})
  set_target_properties(${library} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_compile_options(${library} PRIVATE -fno-semantic-interposition)
endforeach()

target_compile_features(ergocast_core PUBLIC cxx_std_20)
# Eigen's memory layout depends on the vector instructions of the user's build; this fixes those of
# our build.
target_compile_definitions(ergocast_core INTERFACE
  $<INSTALL_INTERFACE:EIGEN_MAX_ALIGN_BYTES=16>
  $<INSTALL_INTERFACE:ERGOCAST_VERSION="${PROJECT_VERSION}">)

set_target_properties(ergocast_core PROPERTIES EXPORT_NAME core)
set_target_properties(ergocast_target PROPERTIES EXPORT_NAME target)
set_target_properties(ergocast_agent_and_codec PROPERTIES EXPORT_NAME agent)
install(TARGETS ${INSTALLED} ergocast_agent_and_codec EXPORT Ergocast COMPONENT dev
  ARCHIVE DESTINATION ${ERGOCAST_LIBDIR} INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
set_target_properties(ergocast_simulation PROPERTIES EXPORT_NAME simulation)
install(TARGETS ${SIMULATION} ergocast_simulation EXPORT ErgocastSimulation COMPONENT dev
  ARCHIVE DESTINATION ${ERGOCAST_LIBDIR} INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT ErgocastSimulation NAMESPACE Ergocast:: FILE ErgocastSimulationTargets.cmake
  DESTINATION ${ERGOCAST_CMAKEDIR} COMPONENT dev)
install(EXPORT Ergocast NAMESPACE Ergocast:: FILE ErgocastTargets.cmake
  DESTINATION ${ERGOCAST_CMAKEDIR} COMPONENT dev)

include(CMakePackageConfigHelpers)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/ErgocastConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_SOURCE_DIR}/cmake/ErgocastConfig.cmake
    ${CMAKE_BINARY_DIR}/ErgocastConfigVersion.cmake
  DESTINATION ${ERGOCAST_CMAKEDIR} COMPONENT dev)

# Their headers. Our sources include "core/basis/basis.h", others "ergocast/core/basis/basis.h".
file(GLOB HEADERS CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR}
  ${CMAKE_SOURCE_DIR}/core/*/*.h ${CMAKE_SOURCE_DIR}/plan/*.h ${CMAKE_SOURCE_DIR}/target/*.h
  ${CMAKE_SOURCE_DIR}/target/maps/*.h ${CMAKE_SOURCE_DIR}/team/*.h ${CMAKE_SOURCE_DIR}/agent/*.h)
list(REMOVE_ITEM HEADERS core/base/vectorized.h core/basis/free_gains.h target/maps/map_text.h
  target/maps/map_yaml.h target/maps/occupancy_map.h target/maps/picture.h target/maps/png_reader.h)
list(APPEND HEADERS lcmtypes/channels.h lcmtypes/codec.h lcmtypes/message_authenticator.h lab/ideal_team.h
  scenario/compile/map_rooms.h scenario/scenario.h scenario/parse/problem.h scenario/parse/source.h studies/study_run.h)
foreach(header ${HEADERS})
  file(STRINGS ${CMAKE_SOURCE_DIR}/${header} needed REGEX "^#include \"")
  list(TRANSFORM needed REPLACE "^#include \"([^\"]+)\".*" "\\1")
  list(REMOVE_ITEM needed ${HEADERS})
  if(needed)
    message(FATAL_ERROR "libergocast-dev has ${header}, but not what it includes: ${needed}")
  endif()
endforeach()
set(INSTALLED_HEADERS ${HEADERS})
configure_file(${CMAKE_SOURCE_DIR}/cmake/install_headers.cmake.in
  ${CMAKE_BINARY_DIR}/install_headers.cmake @ONLY)
install(SCRIPT ${CMAKE_BINARY_DIR}/install_headers.cmake COMPONENT dev)
