# find_package(Ergocast): the targets Ergocast::core, Ergocast::target and Ergocast::agent; with
# COMPONENTS simulation also Ergocast::simulation.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 NO_MODULE)
find_dependency(tl-expected NO_MODULE)
find_dependency(PNG)
include(${CMAKE_CURRENT_LIST_DIR}/ErgocastTargets.cmake)
if("simulation" IN_LIST Ergocast_FIND_COMPONENTS)
  find_dependency(Protobuf)
  find_dependency(pugixml)
  find_dependency(PkgConfig)
  pkg_check_modules(PROJ REQUIRED IMPORTED_TARGET proj)
  include(${CMAKE_CURRENT_LIST_DIR}/ErgocastSimulationTargets.cmake)
endif()
