#!/usr/bin/env bash
# Creates the reference logs log.DATE.NAME.g++.1 of all examples by short runs on one process.
#   LMP=file DATE=24Nov2026 common/reference_logs.sh [FOLDER ...]        only those of these folders
source "$(dirname "${BASH_SOURCE[0]}")/run_common.sh"
cd ..
date=${DATE:-25Nov2026}
folders=" $* "
out=$(mktemp -d)

reference() {    # folder, deck, name, variables
  local folder=$1 deck=$2 name=$3
  shift 3
  if [ "$folders" != "  " ] && [[ "$folders" != *" $folder "* ]]; then return; fi
  rm -f "$folder"/log.*."$name".g++.1
  (cd "$folder" && "$LMP" -in "$deck" -log "log.$date.$name.g++.1" -screen none -var out "$out" "$@")
  # remove the name of the temporary folder and what differs from machine to machine
  sed -i -e "s#$out#results#g" -e '/using .* OpenMP thread/d' "$folder/log.$date.$name.g++.1"
}

reference cluster in.cluster cluster.fib -var trajectories 1 -var duration 10
reference cluster in.cluster cluster.none -var trajectories 1 -var duration 10 -var mobility none
reference cluster in.cluster cluster.pse -var trajectories 1 -var duration 10 -var mobility pse
reference rdf in.rdf rdf.1000 -var dt 50 -var scheme improved -var steps 400
reference rdf in.rdf rdf.3300 -var N 3300 -var scheme improved -var steps 200
reference shear in.shear.single shear.single -var time 50
reference shear in.shear.pair shear.pair -var time 50
reference diffusion in.diffusion diffusion -var blocks 2
reference cell in.cell cell -var samples 100 -var blocks 5
reference channel-flow in.channel-flow channel-flow -var steps 400 -var blocks 4
reference slit in.mobility slit.mobility -var spacing 4
reference duct in.duct duct -var steps 400 -var blocks 4
reference slit in.slit slit -var time 100 -var blocks 4
reference sediment in.mobility sediment.mobility -var places 1
reference sediment in.sediment sediment -var time 20 -var blocks 4
reference dipoles in.dipoles dipoles.newton -var duration 10 -var dt 0.01
reference dipoles in.dipoles dipoles.pse -var motion pse -var start "$out/start.data" -var duration 4 -var dt 0.04
reference dipoles in.dipoles dipoles.none -var motion none -var start "$out/start.data" -var duration 4
reference mixture in.mixture mixture.newton -var dt 0.002 -var relax 1 -var duration 1
reference mixture in.mixture mixture.pse -var motion pse -var start "$out/mixture.data" -var relax 0.1 -var duration 0.2
reference mixture in.mobility mixture.mobility -var steps 40
reference rollers in.single rollers.single -var places 1
reference rollers in.rollers rollers -var duration 0.2
reference rheology in.viscosity rheology.viscosity
reference rheology in.fluctuations rheology.fluctuations -var steps 200
reference rheology in.walls rheology.walls
reference rheology in.shear rheology.shear -var steps 480
reference rheology in.shear rheology.shear.no -var steps 480 -var stresslet no
reference rheology in.moduli rheology.moduli -var omega 5 -var time 5 -var blocks 4
reference rheology in.yield rheology.yield -var N 200 -var duration 0.1 -var peclet 10 -var strain 0.2 -var blocks 4
reference obstacles in.drag obstacles.drag -var kind sc -var number 1
reference obstacles in.posts obstacles.posts -var steps 480
reference suspension in.mobility suspension.mobility -var phi 0.3
reference suspension in.suspension suspension.pse -var phi 0.3 -var steps 500
reference suspension in.suspension suspension.none -var phi 0.3 -var steps 500 -var mobility none
reference polymer in.polymer polymer.pse -var steps 500
reference polymer in.polymer polymer.none -var steps 5000 -var mobility none
reference gel in.gel gel.pse -var N 1000 -var duration 0.3 -var pictures 0
reference gel in.gel gel.none -var N 1000 -var duration 0.3 -var pictures 0 -var mobility none
for deck in 1_sphere 2_diffusion 3_pair 4_wall 5_suspension 6_gel; do reference tutorial in.$deck $deck; done
rm -rf "$out" common/results
