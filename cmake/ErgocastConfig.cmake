# find_package(Ergocast): the targets Ergocast::core, Ergocast::target and Ergocast::agent.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 NO_MODULE)
find_dependency(tl-expected NO_MODULE)
find_dependency(PNG)
include(${CMAKE_CURRENT_LIST_DIR}/ErgocastTargets.cmake)
