% Octave's ode45, ode23 and ode15s with their own events, run by percuss.
%
% `METHOD-default` is what odeset's help says of events: a function of values, which are terminal,
% and directions; the tolerances; the times at which the state is wanted; and nothing else. `METHOD`
% is what an expert adds:
%
% - The time span has two elements. With more of them Octave 7.3 looks at events at these alone.
% - Steps are at most an eighth of a forcing period and of a turn: events are looked for by signs at
%   the ends of steps.
% - Octave finds an event by linear interpolation over the whole step. The root is sought again, by
%   integrating from the beginning of that step.
% - The first step is given: the one that Octave chooses may pass the end of the time span.
% - The first step is short beside the time after which a guard may be zero: a terminal event in the
%   first step does not end the run.
% - ode15s is given the slope at the start, which Octave 7.3 takes to be zero, and the Jacobian.
% - Of all guards that change their signs in a step the first counts; Octave takes the first of the
%   list.
% - A guard that is zero where a mode begins has the sign that it has just after it until the first
%   step is over.
% - What follows an event is told by the first derivative that is not zero.

source(fullfile(fileparts(mfilename("fullpath")), "percuss_program.m"));

% The options of a documentation's example. They are made once a run, because odeset takes longer
% than a step.
function options = usual_options(events)
  global course
  options = course.options;
  if nargin > 0 && ! isempty(course.modes{course.mode}.events)
    options.Events = events;
  end
end

% What an expert adds for a run that begins here: ode15s is told the slope and the Jacobian.
function options = expert_options(t, z, varargin)
  global course
  options = usual_options(varargin{:});
  mode = course.modes{course.mode};
  options.Jacobian = mode.wide(1:mode.size, 1:mode.size);
  options.InitialSlope = rates(t, z);
end

function [value, terminal, direction] = all_events(t, z)
  global course
  events = course.modes{course.mode}.events;
  value = guards(t, z(:));
  terminal = cellfun(@(event) event.ends, events);
  direction = cellfun(@(event) event.sign, events);
end

function by_default(method)
  global course
  while goes_on()
    times = unique([course.t, due(Inf), course.run.span]);
    options = usual_options(@all_events);
    [t, z, te, ze, ie] = method(@rates, times, course.z, options);
    course.steps += numel(t) - 1;
    events = course.modes{course.mode}.events;
    ends = 0;
    for n = 1:numel(ie)
      if events{ie(n)}.ends && n == numel(ie)
        ends = n;
      elseif ! events{ie(n)}.ends
        report(te(n), ie(n), course.mode, ze(n, :).');
      end
    end
    upto = t(end);
    if ends
      upto = te(ends);
    end
    wanted = due(upto);
    [~, rows] = ismember(wanted, t);
    sample(z(rows(rows > 0), :).');
    if ends
      pass(te(ends), ie(ends), ze(ends, :).', true);
    elseif t(end) < course.run.span
      error("the method gave up at %g", t(end));
    else
      course.t = t(end);
      course.z = z(end, :).';
    end
  end
end

% The signs of guards, each of which ends the run. The global `seen` keeps the last two calls, which
% are the ends of the last step: Octave does not tell them.
function [value, terminal, direction] = expert_events(t, z, hidden)
  global seen
  z = z(:);
  [value, ~, direction] = all_events(t, z);
  if t == hidden.t
    zero = hidden.orders > 0;
    value(zero) = hidden.ways(zero) * realmin();
  end
  value(! isfinite(hidden.orders)) = -1;
  terminal = true(size(value));
  if seen(2).t != t
    seen = [seen(2), struct("t", t, "z", z, "value", value)];
  end
end

% The state at a time, from the beginning of a step.
function z = state_at(method, t, begin, z)
  if t - begin <= 64 * eps * abs(t)
    % IDA refuses so short a time.
    z = z + (t - begin) * rates(begin, z);
  else
    options = expert_options(begin, z);
    options.InitialStep = t - begin;
    [~, states] = method(@rates, [begin, t], z, options);
    z = states(end, :).';
  end
end

% Where a guard has its root in the last step: Newton's method, from the secant or the end.
function t = root_of(method, place)
  global course seen
  event = course.modes{course.mode}.events{place};
  ends = [seen(1).value(place), seen(2).value(place)];
  % A guard that begins at zero has another root there: the one that is sought is later.
  t = seen(2).t;
  if abs(ends(1)) > realmin()
    t = seen(1).t - ends(1) * (t - seen(1).t) / (ends(2) - ends(1));
  end
  for n = 1:8
    w = wide_of(t, state_at(method, t, seen(1).t, seen(1).z));
    move = (event.row * w) / (event.row * course.modes{course.mode}.wide * w);
    if ! isfinite(move)
      break
    end
    t = min(max(t - move, seen(1).t), seen(2).t);
    % What is left is the square of it.
    if abs(move) <= 1e-8 * (seen(2).t - seen(1).t)
      break
    end
  end
end

% Takes the samples up to a time: a run of its own, because the one that looks for events has none.
function sample_until(method, upto)
  global course
  wanted = due(upto);
  if ! isempty(wanted)
    times = unique([course.t, wanted, upto]);
    [t, z] = method(@rates, times, course.z, expert_options(course.t, course.z));
    [~, rows] = ismember(wanted, t);
    if numel(times) == 2
      rows(:) = numel(t);
    end
    sample(z(rows, :).');
  end
end

% The time after which a guard may be zero, by its first two derivatives that are not zero.
function time = soonest(orders)
  global course
  mode = course.modes{course.mode};
  w = wide_of(course.t, course.z);
  time = Inf;
  for n = find(isfinite(orders))
    row = mode.events{n}.row * mode.wide ^ orders(n);
    ratio = -(row * w) / (row * mode.wide * w);
    if ratio > 0
      time = min(time, (orders(n) + 1) * ratio);
    end
  end
end

% Runs to the first crossing. Returns its time, the state and the guards that cross there, none at
% the horizon.
function [t, z, crossed] = stretch(method, orders, ways)
  global course seen
  seen = repmat(struct("t", -1, "z", [], "value", []), 1, 2);
  hidden = struct("t", course.t, "orders", orders, "ways", ways);
  times = course.run.times;
  turn = min([times.period, times.turn]);
  left = course.run.span - course.t;
  options = expert_options(course.t, course.z, @(t, z) expert_events(t, z, hidden));
  options.MaxStep = 0.125 * turn;
  options.InitialStep = min([1e-3 * turn, left, max(0.25 * soonest(orders), 1e-12 * turn)]);
  solved = method(@rates, [course.t, course.run.span], course.z, options);
  course.steps += numel(solved.x) - 1;
  t = solved.x(end);
  z = solved.y(:, end);
  crossed = [];
  found = [];
  if isfield(solved, "ie") && ! isempty(solved.ie)
    signs = cellfun(@(event) event.sign, course.modes{course.mode}.events);
    way = sign(sign(seen(2).value) - sign(seen(1).value));
    found = find(way != 0 & (signs == 0 | signs == way));
  end
  % An event at the begin, which an entry's zero may be taken for, ends nothing.
  if isempty(found)
    if t < course.run.span
      error("the method gave up at %g", t);
    end
    return
  end
  roots = Inf(size(signs));
  for n = found
    roots(n) = root_of(method, n);
  end
  t = min(roots);
  crossed = find(roots == t);
  z = state_at(method, t, seen(1).t, seen(1).z);
end

function by_experts(method)
  global course
  passed = [];
  [orders, ways, fires] = enter(passed);
  while goes_on()
    if fires
      passed = course.modes{course.mode}.events{fires};
      pass(course.t, fires, course.z, false);
      [orders, ways, fires] = enter(passed);
      continue
    end
    [t, z, crossed] = stretch(method, orders, ways);
    sample_until(method, t * (1 - eps) * (! isempty(crossed)) + t * isempty(crossed));
    events = course.modes{course.mode}.events;
    ends = crossed(cellfun(@(event) event.ends, events(crossed)));
    for n = setdiff(crossed, ends)
      report(t, n, course.mode, z);
    end
    if ! isempty(ends)
      passed = events{ends(1)};
      pass(t, ends(1), z, false);
      [orders, ways, fires] = enter(passed);
    else
      course.t = t;
      course.z = z;
      % Its guards are zero where the next stretch begins, and go on the way they went.
      [orders, ways, fires] = enter([]);
      for n = crossed
        [~, ways(n)] = leading(events{n}.row * course.modes{course.mode}.wide, course.mode, t, z, []);
        orders(n) = 1;
      end
      fires = 0;
    end
  end
end

function make(setup)
  global course
  tolerance = course.run.tolerance;
  course.options = odeset("RelTol", tolerance.relative, "AbsTol", tolerance.absolute);
  methods = struct("ode45", @ode45, "ode23", @ode23, "ode15s", @ode15s);
  name = strrep(setup, "-default", "");
  if strcmp(name, setup)
    by_experts(methods.(name));
  else
    by_default(methods.(name));
  end
end

function text = setups()
  methods = {"ode45", "Runge-Kutta 5(4) of Dormand and Prince", "explicit", "5"; ...
             "ode23", "Runge-Kutta 3(2) of Bogacki and Shampine", "explicit", "3"; ...
             "ode15s", "BDF of orders 1 to 5, by IDA", "multistep", "null"};
  each = {};
  for n = 1:rows(methods)
    for suffix = {"", "program"; "-default", "library"}.'
      each{end + 1} = sprintf(["{\"name\":\"%s%s\",\"method\":\"%s\",\"class\":\"%s\"," ...
                               "\"order\":%s,\"events\":\"%s\",\"dense_output\":true," ...
                               "\"stepping\":\"adaptive\"}"], methods{n, 1}, suffix{1}, ...
                              methods{n, 2}, methods{n, 3}, methods{n, 4}, suffix{2});
    end
  end
  text = ["[", strjoin(each, ","), "]"];
end

serve("octave", OCTAVE_VERSION(), setups(), @make);
