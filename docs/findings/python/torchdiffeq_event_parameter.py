"""torchdiffeq: the derivative of an event's time by a parameter of the event function is lost."""

import torch
import torchdiffeq
from torchdiffeq import odeint_event

torch.set_default_dtype(torch.float64)
print("torchdiffeq", torchdiffeq.__version__, "- x' = r, x(0) = 0, event at x = b: T = b/r")
rate = torch.tensor(2.0, requires_grad=True)
bound = torch.tensor(3.0, requires_grad=True)
options = {"rtol": 1e-9, "atol": 1e-9, "method": "dopri5"}
time, _ = odeint_event(
    lambda t, x: rate.reshape(1),
    torch.zeros(1),
    torch.tensor(0.0),
    event_fn=lambda t, x: x - bound,
    **options,
)
by_rate, by_bound = torch.autograd.grad(time, [rate, bound], allow_unused=True)
print(f"dT/dr is {float(by_rate):.6f}, expected {-3 / 4:.6f}")
print(f"dT/db is {by_bound}, expected {1 / 2:.6f}")

# The same, with the parameter as a state that stays as it is.
time, _ = odeint_event(
    lambda t, x: torch.stack([rate, torch.zeros(())]),
    torch.stack([torch.zeros(()), bound]),
    torch.tensor(0.0),
    event_fn=lambda t, x: (x[0] - x[1]).reshape(1),
    **options,
)
(by_bound,) = torch.autograd.grad(time, [bound])
print(f"dT/db with b as a state is {float(by_bound):.6f}")
