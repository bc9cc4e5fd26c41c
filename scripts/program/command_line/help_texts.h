// Text that `--help` shows below the options: notes, examples that can be typed as they
// stand, exit codes.
#pragma once

namespace foldproof::help {

constexpr const char* whole_program =
    R"(Examples:
  foldproof verify                                     the quick tier, and results/report.html
  foldproof simulate hanging_sheet                     one case, into results/
  foldproof check bending                              all checks of bending
  foldproof list                                       what there is: checks, laws, cases, claims
`foldproof COMMAND --help` explains a command, with examples.

Exit codes:
  0    everything holds
  1    something fails
  2    bad input, or a file that cannot be read or written
  130  ended by Ctrl-C (143: by SIGTERM))";

constexpr const char* list =
    R"(Examples:
  foldproof list cases                                 the names of the shipped cases
  foldproof list --json                                everything, also the findings of cases

Exit codes:
  0    listed
  2    bad input)";

constexpr const char* claims =
    R"(Examples:
  foldproof claims B10                                 one claim: its ruling, and the findings
  foldproof claims --paper BFA02                       the claims of one paper

Exit codes:
  0    shown; the rulings do not matter
  2    bad input; there is no finished run, or no such claim)";

constexpr const char* report =
    R"(Needs the Debian packages python3-h5py, python3-matplotlib and python3-jinja2; --pdf also chromium.
Folders that `judge --out` wrote become one page of laws by solvers, compare.html in the last of
them, with its numbers in compare.json.

Examples:
  foldproof report results --summary                   one page: what was tested, what holds
  foldproof report results mine                        what differs: mine/compare.html

Exit codes:
  0    written; its path is printed
  2    there is nothing to report on, it cannot be read, or a package is missing)";

constexpr const char* history =
    R"(Needs the Debian packages python3-h5py, python3-matplotlib and python3-jinja2.

Examples:
  foldproof history results-monday results             what changed from one run to the next
  foldproof history results --log history.jsonl        append this run to a log, then show it

Exit codes:
  0    every finding that held before still holds in the newest run
  1    a finding that held before no longer holds
  2    bad input, or a package is missing)";

constexpr const char* film =
    R"(Needs the Debian packages ffmpeg, python3-h5py, python3-matplotlib and python3-pil.

Examples:
  foldproof film results/grab.h5
  foldproof film results/grab.h5 --field strain --size 640x360 --out strain.mp4

Exit codes:
  0    written; the paths are printed
  2    bad input, or a package is missing)";

constexpr const char* export_frames =
    R"(Lengths are in metres, in world coordinates; each object has files of its own.
Needs the Debian packages python3-h5py and python3-numpy.

Examples:
  foldproof export results/grab.h5 --format ply --out frames
  foldproof export results/grab.h5 --format xdmf --out paraview

Exit codes:
  0    written
  2    bad input, or a package is missing)";

constexpr const char* inspect =
    R"(Examples:
  foldproof inspect cases/limb.obj --cells 100 --json
  foldproof inspect cases/skirt.obj --cloth            its rigidity by direction, its elastic limit

Exit codes:
  0    the mesh is a solid, and ray casting agrees on what is inside; or a cloth was inspected
  1    the mesh is not a solid, or ray casting disagrees
  2    bad input)";

constexpr const char* judge =
    R"(Without an adapter: --frames judges files that any program wrote, as a motion of the case's cloth:
crossings, depth in objects, strain, folds, energy, and what the case expects.

CMD starts an adapter that speaks the protocol of verification/subjects/PROTOCOL.md, in a process of
its own. Simple laws (smoke) come first: if one fails, suspect the adapter. If the solver crashes,
hangs or answers nonsense, the current law fails and shows its last output; the next law then runs.
If it cannot be started, hangs a third time, or --total-seconds are over, the laws that are left do
not run. Name laws or groups to judge only those, such as: contact symmetry.mirror

Examples:
  foldproof judge --frames my_frames --case drape_sphere --rate 60 --out mine
  foldproof judge --solver ./adapter --name mine --settings iterations=20 --out mine

Exit codes:
  0    every law holds, or does not apply; with --baseline: nothing got worse
  1    a law fails, is inconclusive or did not run; with --baseline: something got worse
  2    bad input)";

constexpr const char* subject =
    R"(Calls each operation of the declared level once, on a small sheet.

Examples:
  foldproof subject --check "/usr/bin/python3 verification/subjects/adapters/toy_solver.py"
  (in a clone; needs the Debian package python3-numpy)

Exit codes:
  0    the adapter keeps to the protocol
  1    the adapter breaks the protocol; the message names the first violation
  2    bad input)";

constexpr const char* serve =
    R"(Started by `judge`, `subject` or another program that speaks verification/subjects/PROTOCOL.md: it
reads from the descriptor FOLDPROOF_IN and writes to FOLDPROOF_OUT.

Examples:
  foldproof judge --solver "foldproof serve"
  foldproof judge --solver "foldproof serve --integrator A --precision f4"

Exit codes:
  0    asked to stop
  2    bad input, or no other program has started it)";

constexpr const char* crossings =
    R"(Examples:
  foldproof crossings results/fast.h5
  foldproof crossings cases/skirt.obj cases/robe.obj

Exit codes:
  0    nothing crosses
  1    in some frame an edge crosses a triangle
  2    bad input)";

constexpr const char* golden =
    R"(Prints a heading, then rows of numbers to 17 digits; a vector has three columns, NAME_x, NAME_y and
NAME_z. --json adds the formula, and each column's meaning and unit. All outputs are computed with
50 digits and rounded once. verification/GOLDEN.md has examples in Python and C++.

Examples:
  foldproof golden friction --count 100
  foldproof golden bending --count 5 --seed 3 --json

Exit codes:
  0    printed
  2    bad input)";

constexpr const char* evaluate =
    R"(Examples:
  foldproof evaluate bending cases/hinges.csv
  foldproof evaluate crossings --help                  the format of a file of queries

Exit codes:
  0    evaluated, and nothing disagrees
  1    crossings: something disagrees with the file
  2    bad input)";

constexpr const char* evaluate_bending =
    R"(Prints the bending forces of single hinges, for comparison with your code. Each row of FILE has 27
comma-separated numbers: x1 x2 x3 x4 (12 position components [m]), v1 v2 v3 v4 (12 velocity
components [m/s]), ke [J], kd [N s], theta0 [rad]. Output: 12 elastic and 12 damping force
components [N] to 17 digits. The weight |E|^2/(|N1|+|N2|) is computed at the current positions, or
with --rest at the rest positions, in rows of 12 numbers.

Examples:
  foldproof evaluate bending cases/hinges.csv

Exit codes:
  0    printed
  2    bad input; the line is named)";

constexpr const char* evaluate_crossings =
    R"(A row of FILE is a point, in integers: numerator and denominator of x, y and z, then 1 if the
features of this query meet, else 0. Eight rows are a query: four points at the start of a motion
along straight lines, then the same four at its end. vertex-face: the vertex, then the triangle's
corners. edge-edge: the ends of the first edge, then of the second.

Examples:
  foldproof evaluate crossings queries.csv --kind vertex-face
  foldproof evaluate crossings queries/edge-edge --keep 1e-5

Exit codes:
  0    the reference misses no meeting, and the exact judge agrees with the file
  1    the reference misses a meeting, or the exact judge disagrees with the file
  2    bad input; the line is named)";

constexpr const char* simulate =
    R"(A checkpoint is written at every frame and removed at the end. An interrupted run prints how to
resume it. The same command without --resume or --restart then stops, and deletes nothing.

Examples:
  foldproof simulate hanging_sheet --set bending.stiffness=1e-3 --out mine
  foldproof simulate any_mesh --set cloth.mesh=cases/skirt.obj --out mine

Exit codes:
  0    the run reached its end time, and every expectation of the case holds
  1    an expectation fails, or the run stopped early and prints why
  2    bad input, checkpoints of an interrupted run, or a file that cannot be written
  130  interrupted by Ctrl-C (143: by SIGTERM))";

constexpr const char* verify =
    R"(Results are kept in DIR/unfinished as they come, and deleted at the end. A run that was interrupted
goes on with --resume, if program, tier and seed are the same; the report names the commits.

Examples:
  foldproof verify
  foldproof verify --tier full --out full --resume     hours, also in parts

Exit codes:
  0    everything holds, and the ruling on every claim is as recorded
  1    something fails or is inconclusive, or more than 5 % of the bounds are empirical
  2    bad input, or a file that cannot be written)";

constexpr const char* bench =
    R"(Examples:
  foldproof bench --quick

Exit codes:
  0    measured; the numbers do not matter
  2    bad input, or a file that cannot be written)";

constexpr const char* ablate =
    R"(First finds the scene's own error, as converge does: that of its steps, from steps halved twice,
and that of its mesh, from edges halved once (--mesh-levels 3: twice, in ten times the time). With
two meshes, the error bar is three times their difference. OUT/store keeps these runs; those that
converge left there are not repeated. Then ablate removes one part at a time, and adds, one at a
time, the missing parts that need no parameters: self-collision, strain limits, points between
particles. A part is needed, or missing, if one of these happens without it:
- particles move by more than the scene's own error, error bar included;
- the run does not reach its end, or an expectation of the case fails or loses its meaning;
- the cloth crosses itself, or lies deeper in an object by more than the scene's own error.
Where a change exceeds the error, but not the error with its bar, ablate says "cannot tell". The
table [ablation] of a case file can justify a part that is not needed, or the lack of one that is.
It can name a coarser mesh where a finer one would take hours, and limit ablate to the beginning of
a run.

Examples:
  foldproof ablate hinge
  foldproof ablate grab --set time.end=0.2 --out mine

Exit codes:
  0    every part is needed, none is missing
  1    a part (marked !) is not needed, or is missing, and the case gives no reason; or it gives one
       that is not called for; or the unchanged scene stops early, or fails an expectation
  2    bad input, or a file that cannot be written)";

constexpr const char* converge =
    R"(Runs the case as it is, then refined level by level. Prints for each quantity the order at which
differences between levels fall, Richardson's limit, and the grid convergence index as error bar
(safety factor 1.25 where the order has settled at the method's, else 3). Quantities are those of
the case's [[quantity]] tables; without any: positions, energies, heights, quantities in [expect].

--in time    halves every step at each level.
--in space   halves every edge at each level: shapes by their counts, such as columns and rows;
             other meshes are split at the middles of edges. Positions are compared at the case's
             own particles. In [[hold]], a box holds a region, a list of particles holds points.
             All meshes take the steps that the finest one needs; one more run, with half the
             step, measures their error.
--in both    does both, and maps the error over step and mesh: names the cheapest pair for each of
             --errors, forecasts its cost, and says what half the error costs.

Two more runs start disturbed: by 1e-12 of the cloth's extent, and by the size of the step's error.
When they differ from the undisturbed run by --fraction of its motion, positions are no longer
predictable. Orders and error bars use only the time before that. For the time after it, --ensemble
disturbed runs give means over time of height, energies, contacts and fold angles, and their spread.

--solver CMD also runs another solver (verification/subjects/PROTOCOL.md), with equal steps from
frame to frame that are halved in the same way. Says how far its finest run is from the reference's,
and whether both error bars explain that. A case can have what the protocol can say: particles held
still, self-collision, and planes, boxes, spheres and capsules at rest. The solver's runs are not
kept.

The folder keeps every run: an interrupted call resumes; a second call runs only what is missing.
The two coarsest levels run alone first and show what the others will cost. A level that exceeds the
memory or --hours is refused; the other levels still give a result. Seconds are processor time of a
run's own thread. DIR/converge.h5 is for `foldproof report DIR`.

Examples:
  foldproof converge hanging_sheet --solver ./adapter --settings iterations=20
  foldproof converge hanging_sheet --in space --set cloth.columns=6 --set cloth.rows=6 --until 0.3

Exit codes:
  0    the positions have an order, or at least an error bar
  1    the order of the positions is inconclusive
  2    bad input, or a file that cannot be written)";

constexpr const char* precision =
    R"(Runs the case with every integrator, at constant steps that are halved from run to run. Prints for
each wanted error the cheapest method and its step, and the price of each other method as a multiple
of the cheapest. A price counts applications of force operators.

error   distance from the truth, divided by the motion. The distance is the root mean square over
        the free particles, weighted by mass, in the worst frame; the motion is the largest such
        distance from the start.
truth   two methods of different families, each extrapolated where its order has settled. An error
        less than ten times their distance gets no price.
price   interpolated between the two runs that bracket the error. Methods are tied if their prices
        are closer than the steps tried. The steps of the cheapest methods must also last: in a run
        at least three times as long, and at least to the end of the case (--until shortens it),
        the kinetic energy is at most twice that with half the step. If such a run costs more than
        20 times the budget, the answer is the automatic step.

--solver CMD also finds step and price of another solver (verification/subjects/PROTOCOL.md).
Its steps are equal from frame to frame, and halved until the error bar of the finest run is a tenth
of the least wanted error, or a run would take 10 s (times --effort) by the clock. Longer steps are
tried, up to a frame, until they miss the largest wanted error or are unstable; if a whole frame
reaches an error, its step is a lower bound, printed as >=. The error is the distance from the
finest run, and that run's error bar, over the reference's motion. Says how far the solver's limit
is from the reference's truth, and whether steps explain it. Its runs are not kept.

Examples:
  foldproof precision hanging_sheet --until 0.2 --solver ./adapter --settings iterations=20
  foldproof precision hanging_sheet --method A,C,RK4 --errors 1e-2 --out mine

Exit codes:
  0    every wanted error is reached by some method, and by the solver; the truth is good for it
  1    no method, or not the solver, reaches an error; or the truth is not known well enough
  2    bad input, or a file that cannot be written)";

constexpr const char* campaign =
    R"(Examples:
  foldproof campaign plan mine.campaign.toml
  foldproof campaign run mine.campaign.toml            all cores; --on slurm: a cluster

Exit codes:
  0    as the command's own help says
  2    bad input)";

constexpr const char* campaign_plan =
    R"(Contacts no engine, and keeps no result of the sample.

Examples:
  foldproof campaign plan bending_atlas

Exit codes:
  0    planned
  2    bad input)";

constexpr const char* campaign_run =
    R"(Runs every job that has no result in the store: nothing is run twice, not even by two
campaigns. Failures are results. A killed job is started again, up to three times. After Ctrl-C the
same command resumes; a batch in a queue goes on without it.

Examples:
  foldproof campaign run bending_atlas --out mine
  foldproof campaign run bending_atlas --out mine --on slurm

Exit codes:
  0    every job has a result and holds
  1    a job failed, stopped, was refused or crashed; or a repetition found something else
  2    bad input, or a file that cannot be written
  130  interrupted by Ctrl-C (143: by SIGTERM))";

constexpr const char* campaign_table =
    R"(Writes DIR/campaigns/NAME/table.csv and table.h5, a row a job. DIR/store/index.sqlite answers SQL.

Examples:
  foldproof campaign table bending_atlas --out mine

Exit codes:
  0    written; everything in [expect] holds
  1    written; an expectation fails, or waits for jobs that have no result
  2    bad input, or a file that cannot be written)";

constexpr const char* campaign_report =
    R"(Needs the Debian packages python3-matplotlib and python3-jinja2. Writes
DIR/campaigns/NAME/report.html, with every [[figure]] of the campaign; failures are drawn as such.

Examples:
  foldproof campaign report bending_atlas --out mine

Exit codes:
  0    written; its path is printed
  2    bad input, or a package is missing)";

constexpr const char* campaign_status =
    R"(Examples:
  foldproof campaign status bending_atlas --out mine

Exit codes:
  0    every job has ended
  1    jobs run, or are missing
  2    bad input)";

constexpr const char* campaign_watch =
    R"(Prints a line every two seconds, and keeps DIR/campaigns/NAME/watch.html, which refreshes itself.

Examples:
  foldproof campaign watch bending_atlas --out mine

Exit codes:
  0    nothing runs any more, and every job has ended
  1    nothing runs any more, and jobs are missing
  2    bad input)";

constexpr const char* campaign_cancel =
    R"(Examples:
  foldproof campaign cancel bending_atlas --out mine

Exit codes:
  0    cancelled, or nothing ran
  2    bad input; the engine refuses, or it runs on another machine)";

constexpr const char* campaign_emit =
    R"(Prints one command for each slice of missing jobs. They may run anywhere that sees the store, in any
order, and more than once. Afterwards the other commands find their results.

Examples:
  foldproof campaign emit bending_atlas --out mine

Exit codes:
  0    printed
  2    bad input, or a file that cannot be written)";

constexpr const char* campaign_work =
    R"(Runs the jobs of its slice that have no result, on --threads processes. Refuses a batch that another
build of the program planned.

Examples:
  foldproof campaign work mine/store/batches/NAME --slice 0 --threads 1

Exit codes:
  0    every job of the slice has a result
  1    some have none
  2    bad input, or results that cannot be written)";

constexpr const char* compare =
    R"(Frames that have the run's vertices and triangles are compared vertex by vertex, other meshes by
the nearest points of both surfaces. Prints for each frame: distances, energies of stretching and
bending computed with the run's forces, the distribution of fold angles, self-crossing pairs, and
the depth in the run's objects. Between two frames of the run, its cloth is interpolated from
positions and velocities.

Examples:
  foldproof compare results/grab.h5 captured --rate 60 --start 0.5
  foldproof compare results/grab.h5 frames --out mine && foldproof report mine

Exit codes:
  0    compared; the distance does not matter
  2    bad input; a frame cannot be read, or none lies in the run's time)";

constexpr const char* smooth =
    R"(Subdivides the cloth of every frame by Loop's rule, each triangle into four a level. Where the
smooth surface would cross itself, points stop on the way there from the cloth's own triangles.
Prints, for each frame, how many pairs of an edge and a triangle cross in the run, on Loop's surface
and on the smooth one (decided exactly), and how far points came on average. A cloth that crosses
itself stays crossed.

Examples:
  foldproof smooth results/grab.h5 --levels 2

Exit codes:
  0    no frame crosses itself
  1    a frame of the smooth surface crosses itself, as the run's does
  2    bad input, or a file that cannot be written)";

constexpr const char* project =
    R"(Prints how many points moved. For the last frame it also prints how much of the wrinkles is left
before projection, after plain projection, and after the map: the standard deviation of the depths
of points that were inside, and the peak of the spectrum of depth along a section of the cloth.
Points between two objects are left alone. Points end at most tau/10^6 farther out than the map
says.

Examples:
  foldproof project results/half_inside.h5 --map blend --tau 0.01

Exit codes:
  0    all points are out
  1    some points have too little clearance between objects
  2    bad input, or a file that cannot be written)";

constexpr const char* check =
    R"(Examples:
  foldproof check bending                              all checks of bending
  foldproof check case.hinge --json                    what is expected of a shipped case

Exit codes:
  0    everything holds
  1    something fails or is inconclusive
  2    bad input; a name matches nothing)";

constexpr const char* study =
    R"(Examples:
  foldproof study time-order.hinge
  foldproof study work-precision --tier full --out mine

Exit codes:
  0    everything holds
  1    something fails or is inconclusive
  2    bad input; a name matches nothing)";

}  // namespace foldproof::help
