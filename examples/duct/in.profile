# Poiseuille flow in a square duct: no-slip walls on four sides, periodic along the axis, a force density on the fluid.
# Particles at temperature 0, in a quarter of the cross section, move with the fluid.
#   n          number of cells across; the duct is 16 wide for any n
#   density    force per volume on the fluid
#   out        folder for the result: profile.n.dat, y, z and velocity along the axis

variable n         index 16
variable density   index 0.1
variable out       index .
variable length    equal 8*16/v_n                  # 8 cells along the axis

units         lj
boundary      p f f
atom_style    atomic
region        box block 0 ${length} 0 16 0 16 units box
create_box    1 box
mass          1 1.0
lattice       sc 8.0                               # spacing 0.5
region        probes block -0.1 0.1 0.4 8.1 0.4 8.1 units box
create_atoms  1 region probes
neigh_modify  every 1 delay 0 check yes
comm_modify   cutoff 1.0

fix           move all bd/fib 0.0 1.0 1 grid 8 ${n} ${n} kernel bkp6 fft estimate force ${density} 0 0 &
              wall ylo noslip wall yhi noslip wall zlo noslip wall zhi noslip
timestep      1e-9
thermo_style  custom step f_move[1] f_move[16] f_move[19] f_move[22] f_move[25]
run           1
dump          profile all custom 1 ${out}/profile.${n}.dat y z vx
dump_modify   profile sort id format float %.15g
run           0
# friction of the fluid on the four walls, which together carry the driving force
print         "FRICTION $(f_move[16]) $(f_move[19]) $(f_move[22]) $(f_move[25]) of $(v_density*v_length*256)" &
              file ${out}/friction.${n}.dat
