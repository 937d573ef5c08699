% Programs that percuss runs as engines, for Octave: the protocol, and a system's equations.
%
% A program calls `serve` with what it can do and with a function that makes a run. The protocol is
% described in docs/PROTOCOL.md; what it counts from 0 is counted from 1 here. The run as it is made
% is the global `course`, because integrators call functions that count and change it.

1;

% Displacements of so many roundings are none, and times so close are one instant.
function value = rounding()
  value = 1024 * eps;
end
function value = one_instant()
  value = 8 * eps;
end

% A list of objects is an array of structures, one of lists a matrix; both may be empty.
function event = read_event(wire, columns)
  event.row = wire.guard(:).';
  event.sign = struct("rising", 1, "falling", -1, "both", 0).(wire.direction);
  event.reset = eye(columns);
  if ! isempty(wire.reset)
    event.reset(1:columns - 3, :) = reshape(wire.reset, columns - 3, columns);
  end
  event.successors = wire.successors;
  event.ends = ! isempty(wire.successors);
end

% A mode: w' = M w, with w = (z, cos theta, sin theta, 1).
function mode = read_mode(wire, omega)
  mode.size = n = numel(wire.c);
  a = reshape(wire.A, n, n);
  b = reshape(wire.B, n, 2);
  mode.wide = [a, b, wire.c(:); zeros(3, n + 3)];
  mode.wide(n + 1, n + 2) = -omega;
  mode.wide(n + 2, n + 1) = omega;
  mode.events = {};
  for event = wire.events(:).'
    mode.events{end + 1} = read_event(event, n + 3);
  end
end

function begin_course(run)
  global course
  course = struct("run", run, "omega", run.system.omega, "phi", run.system.phi);
  course.modes = {};
  for mode = run.system.modes(:).'
    course.modes{end + 1} = read_mode(mode, course.omega);
  end
  course.t = 0;
  course.mode = run.mode + 1;
  course.z = run.state(:);
  course.samples = run.samples(:).';
  course.sampled = zeros(numel(course.z), 0);
  course.events = {};
  course.ended = "";
  course.gave_up = "";
  course.crowd = course.stretches = course.progress = course.rhs = course.jacobians = course.steps = 0;
  course.deadline = time() + run.limits.wall_s;
  sample_here();
end

function w = wide_of(t, z)
  global course
  theta = course.omega * t + course.phi;
  w = [z; cos(theta); sin(theta); 1];
end

% Ends a run that goes beyond its limits.
function give_up(why)
  global course
  course.gave_up = why;
  error(why);
end

% The right-hand side in the mode of now.
function out = rates(t, z)
  global course
  course.rhs += 1;
  if course.rhs + course.jacobians > course.run.limits.calls
    give_up("too many calls");
  elseif mod(course.rhs, 256) == 0 && time() > course.deadline
    give_up("the time is over");
  end
  mode = course.modes{course.mode};
  out = mode.wide(1:mode.size, :) * wide_of(t, z);
end

% The values of all guards of the mode of now.
function out = guards(t, z)
  global course
  w = wide_of(t, z);
  out = cellfun(@(event) event.row * w, course.modes{course.mode}.events);
end

% Whether a row is a multiple of another one, of 0 at the least.
function out = is_multiple(row, of)
  size = of * of.';
  out = norm(row * size - of * (row * of.')) <= 1e-12 * size * norm(row);
end

% The order and the sign of the first derivative of row . w along a mode that is not zero. What is a
% multiple of the guard that was `passed` is zero there, whatever rounding says.
function [order, way] = leading(row, mode, t, z, passed)
  global course
  w = wide_of(t, z);
  for order = 0:numel(w) - 1
    known = ! isempty(passed) && is_multiple(row * passed.reset, passed.row);
    value = row * w;
    if ! known && abs(value) > rounding() * (abs(row) * abs(w))
      way = sign(value);
      return
    end
    row = row * course.modes{mode}.wide;
  end
  order = Inf;
  way = 0;
end

% The order and the sign of each guard where a mode begins, and the first that ends it at once, or
% 0.
function [orders, ways, fires] = enter(passed)
  global course
  events = course.modes{course.mode}.events;
  orders = ways = zeros(1, numel(events));
  fires = 0;
  for n = 1:numel(events)
    [orders(n), ways(n)] = leading(events{n}.row, course.mode, course.t, course.z, passed);
    if events{n}.ends && ways(n) > 0 && fires == 0
      fires = n;
    end
  end
end

% The instants that are still wanted, up to a time.
function times = due(upto)
  global course
  times = course.samples(columns(course.sampled) + 1:end);
  times = times(times <= upto);
end

function sample(states)
  global course
  course.sampled = [course.sampled, states];
end

% Takes the samples that are due now.
function sample_here()
  global course
  sample(repmat(course.z, 1, numel(due(course.t))));
end

% Reports an event and the state after it. `before` is the state before its reset; of an event that
% is only counted it is left out, and is the state itself.
function report(t, event, mode, z, before)
  global course
  if nargin < 5
    before = z;
  end
  if numel(course.events) >= course.run.limits.events
    give_up("too many events");
  end
  course.events{end + 1} = sprintf(["{\"time\":%.17g,\"event\":%d,\"mode\":%d,\"before\":%s," ...
                                    "\"state\":%s}"], t, event - 1, mode - 1, numbers(before), ...
                                   numbers(z));
end

% Goes through an event that ends its mode. `plainly` decides what follows by the signs of
% conditions alone, zero or not.
function pass(t, place, z, plainly)
  global course
  if course.run.backward
    course.t = t;
    course.z = z;
    course.ended = "leaves-domain";
    return
  end
  event = course.modes{course.mode}.events{place};
  before = z;
  after = event.reset * wide_of(t, before);
  z = after(1:numel(before));
  for successor = event.successors(:).'
    when = successor.when(:).';
    if isempty(when) || (plainly && when * after > 0)
      break
    elseif ! plainly
      [~, way] = leading(when, successor.mode + 1, t, z, event);
      if way > 0
        break
      end
    end
  end
  report(t, place, successor.mode + 1, z, before);
  if t - course.t <= one_instant() * t
    course.crowd += 1;
  else
    course.crowd = 1;
  end
  course.t = t;
  course.mode = successor.mode + 1;
  course.z = z;
  if course.crowd >= 64
    course.ended = "no-progress";
  end
end

% Whether the run has not come to its end; asked once a stretch. So many stretches in so little of a
% run are one event that is found again and again.
function out = goes_on()
  global course
  course.stretches += 1;
  if course.t - course.progress > 1e-9 * course.run.span
    course.stretches = 0;
    course.progress = course.t;
  elseif course.stretches > 200
    error("events at %.17g are found again and again", course.t);
  end
  out = isempty(course.ended) && course.run.span - course.t > 2 * one_instant() * course.run.span;
end

% Numbers in JSON, each so that it reads back to the same double.
function text = numbers(values)
  if ! all(isfinite(values))
    error("a state is not finite");
  end
  text = ["[", strjoin(arrayfun(@(it) sprintf("%.17g", it), values(:).', "UniformOutput", false), ...
                       ","), "]"];
end

function text = answer_run(seconds)
  global course
  ended_at = course.t;
  ended = course.ended;
  if isempty(ended)
    ended = "horizon";
    ended_at = course.run.span;
    sample(repmat(course.z, 1, numel(due(Inf))));
  end
  sampled = cellfun(@numbers, num2cell(course.sampled, 1), "UniformOutput", false);
  text = sprintf(["\"run\":{\"events\":[%s],\"samples\":[%s],\"end\":%s,\"ended\":\"%s\"," ...
                  "\"ended_at\":%.17g,\"work\":{\"rhs\":%d,\"jacobians\":%d,\"steps\":%d}," ...
                  "\"own_ns\":%d}"], strjoin(course.events, ","), strjoin(sampled, ","), ...
                 numbers(course.z), ended, ended_at, course.rhs, course.jacobians, course.steps, ...
                 floor(1e9 * seconds));
end

% A run, or why there is none.
function text = made(make, run)
  global course
  begin_course(run);
  try
    began = tic();
    make(run.setup);
    text = answer_run(toc(began));
  catch why
    if isempty(course.gave_up)
      text = ["\"failure\":", jsonencode(why.message)];
    else
      text = ["\"gave_up\":", jsonencode(course.gave_up)];
    end
  end
end

% The next request; empty when there are no more. `fgetl` would wait for the line after it.
function line = next_line()
  try
    line = input("", "s");
  catch
    line = "";
  end
end

% Answers requests until there are no more. `setups` is a list in JSON.
function serve(library, version, setups, make)
  warning("off", "all");
  while ! isempty(line = next_line())
    request = jsondecode(line);
    switch request.ask
      case "capabilities"
        text = sprintf(["\"capabilities\":{\"library\":\"%s\",\"version\":\"%s\"," ...
                        "\"language\":\"Octave %s\",\"setups\":%s}"], library, version, ...
                       version, setups);
      case "run"
        text = made(make, request.run);
      otherwise
        text = "\"ready\":true";
    end
    printf("{\"percuss_protocol\":1,\"id\":%d,%s}\n", request.id, text);
    fflush(stdout);
  end
end
