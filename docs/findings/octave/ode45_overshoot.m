% Octave's ode45: the first step is not shortened to the time span, and passes its end.

1;

printf("Octave %s - expected: the run ends at t = 1.9\n", OCTAVE_VERSION());
warning("off", "all");
for longest = [0.005, 0.5]
  options = odeset("RelTol", 1e-6, "AbsTol", 1e-6, "MaxStep", longest);
  found = ode45(@(t, y) [y(2); -1], [1.89, 1.9], [0; 0.03], options);
  printf("a longest step of %g: the run ends at t = %g\n", longest, found.x(end));
end
