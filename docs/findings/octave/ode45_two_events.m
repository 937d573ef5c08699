% Octave's ode45: of two events in one step the first of the list is reported, not the first in
% time; and one that is not terminal is reported in place of the terminal one that ends the run.

1;

function [value, terminal, direction] = levels(t, y)
  value = [y - 0.59, y - 0.51];
  terminal = [false, true];
  direction = [0, 0];
end

printf("Octave %s - y = t; expected: the run ends at 0.51, by event 2\n", OCTAVE_VERSION());
warning("off", "all");
options = odeset("Events", @levels, "InitialStep", 0.2);
[t, ~, te, ~, ie] = ode45(@(t, y) 1, [0, 2], 0, options);
printf("the run ends at %g, by event %d at %g\n", t(end), ie, te);
