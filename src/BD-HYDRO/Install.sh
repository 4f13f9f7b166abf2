# Install/unInstall the BD-HYDRO package in LAMMPS' src folder, for the classical make (`make yes-bd-hydro`).
# mode = 0/1/2 for uninstall/install/update

mode=$1

LC_ALL=C
export LC_ALL

action () {
  if (test $mode = 0) then
    rm -f ../$1
  elif (! cmp -s $1 ../$1) then
    cp $1 ..
    if (test $mode = 2) then
      echo "  updating src/$1"
    fi
  fi
}

for file in *.cpp *.h; do
  test -f ${file} && action $file
done

# The package needs C++17 (this flag comes after the -std=c++11 of the machine makefiles and wins), FFTW in both
# precisions and the headers of Random123 and Eigen (EIGEN3_INCLUDE_DIR says where).  -fno-math-errno lets the compiler vectorise loops with square roots.
flags="-std=c++17 -fno-math-errno -I${EIGEN3_INCLUDE_DIR:-/usr/include/eigen3}"
libraries="-lfftw3 -lfftw3f"

if (test -e ../Makefile.package) then
  sed -i -e "s|-std=c++17 -fno-math-errno -I[^ ]* ||" -e "s|-lfftw3 ||" -e "s|-lfftw3f ||" ../Makefile.package
  if (test $mode != 0) then
    sed -i -e "s|^PKG_INC =[ \t]*|&$flags |" -e "s|^PKG_SYSLIB =[ \t]*|&$libraries |" ../Makefile.package
  fi
fi
