# The rigid ground needs no grains: a target of its own, usable without the sand.
include_guard(GLOBAL)
add_library(hoof_rigid_terrain STATIC ${CMAKE_CURRENT_LIST_DIR}/rigid_terrain.cpp)
target_link_libraries(hoof_rigid_terrain PUBLIC hoof_config Eigen3::Eigen)
