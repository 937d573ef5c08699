% Octave's ode45: events are looked for at output times alone where the time span has more than two
% elements, and found by linear interpolation between them or between the ends of steps.

1;

function [value, terminal, direction] = ground(t, y)
  value = y(1);
  terminal = true;
  direction = -1;
end

printf("Octave %s - a ball falls from 1/2 with speed 1 upwards: it lands at t = %.9f\n", ...
       OCTAVE_VERSION(), 1 + sqrt(2));
warning("off", "all");
for tolerance = [1e-6, 1e-9]
  options = odeset("RelTol", tolerance, "AbsTol", tolerance, "Events", @ground);
  [~, ~, te] = ode45(@(t, y) [y(2); -1], [0, 4], [0.5; 1], options);
  printf("tolerance %g, time span of two:  %.9f\n", tolerance, te);
  [~, ~, te] = ode45(@(t, y) [y(2); -1], [0, 2, 4], [0.5; 1], options);
  printf("tolerance %g, with output at 2:  %.9f\n", tolerance, te);
end
