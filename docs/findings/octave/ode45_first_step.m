% Octave's ode45: a terminal event in the first step does not end the run.

1;

function [value, terminal, direction] = level(t, y)
  value = y - 0.1;
  terminal = true;
  direction = 1;
end

printf("Octave %s - y = t; expected: the run ends at 0.1\n", OCTAVE_VERSION());
warning("off", "all");
for first = [0.15, 0.05]
  options = odeset("Events", @level, "InitialStep", first, "MaxStep", 0.2);
  [t, ~, te] = ode45(@(t, y) 1, [0, 2], 0, options);
  printf("a first step of %g: the run ends at %g, with an event at %g\n", first, t(end), te(1));
end
