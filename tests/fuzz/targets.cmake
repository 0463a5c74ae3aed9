# The fuzz targets, once for every compiler that builds them: hoof_add_fuzz_targets(KIND) makes
# hoof_KIND_decoders, hoof_KIND_candump, hoof_KIND_csv and hoof_KIND_control_loop, each with the extra sources.
set(HOOF_FUZZ_TARGETS decoders candump csv control_loop)

set(here ${CMAKE_CURRENT_LIST_DIR})
set(root ${CMAKE_CURRENT_LIST_DIR}/../..)

set(fuzz_sources_decoders ${here}/decoders_fuzz.cpp)
set(fuzz_libraries_decoders hoof_protocol)
set(fuzz_sources_candump ${here}/candump_fuzz.cpp ${root}/hil_bridge/candump.cpp)
set(fuzz_libraries_candump "")
set(fuzz_sources_csv
  ${here}/csv_fuzz.cpp ${root}/tools/diagnose/csv_table.cpp ${root}/tools/run/output_file.cpp)
set(fuzz_libraries_csv "")
set(fuzz_sources_control_loop
  ${here}/control_loop_fuzz.cpp ${here}/loop_rig.cpp ${here}/loop_watch.cpp
  ${root}/hal/in_process/ram_flash.cpp)
set(fuzz_libraries_control_loop hoof_app)

function(hoof_add_fuzz_targets KIND)
  foreach(target ${HOOF_FUZZ_TARGETS})
    add_executable(hoof_${KIND}_${target} ${fuzz_sources_${target}} ${ARGN})
    target_link_libraries(hoof_${KIND}_${target} PRIVATE ${fuzz_libraries_${target}})
  endforeach()
endfunction()
