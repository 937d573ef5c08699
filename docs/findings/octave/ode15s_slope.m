% Octave's ode15s takes the slope at the start to be zero unless it is told another one.

1;

function attempt(name, f, options)
  try
    [t, z] = ode15s(f, [0, 5], [1; 1], options);
    printf("%s: z(5) is off by %.1e\n", name, abs(z(end, 1) - cos(5) - sin(5)));
  catch problem
    printf("%s: %s\n", name, problem.message);
  end
end

printf("Octave %s - z'' = -z, without events; expected: four runs to t = 5\n", OCTAVE_VERSION());
warning("off", "all");
f = @(t, z) [z(2); -z(1)];
for tolerance = [1e-6, 1e-9]
  options = odeset("RelTol", tolerance, "AbsTol", tolerance);
  attempt(sprintf("tolerance %.0e", tolerance), f, options);
  options = odeset(options, "InitialSlope", f(0, [1; 1]));
  attempt(sprintf("tolerance %.0e, with the slope", tolerance), f, options);
end
