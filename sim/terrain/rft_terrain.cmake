# The fast soil needs no grains: a target of its own, as the rigid ground is.
include_guard(GLOBAL)
add_library(hoof_rft_terrain STATIC
  ${CMAKE_CURRENT_LIST_DIR}/rft_facets.cpp
  ${CMAKE_CURRENT_LIST_DIR}/rft_law.cpp
  ${CMAKE_CURRENT_LIST_DIR}/rft_settings.cpp
  ${CMAKE_CURRENT_LIST_DIR}/rft_terrain.cpp)
target_link_libraries(hoof_rft_terrain PUBLIC hoof_config hoof_effects Eigen3::Eigen)
