"""How long the tests take: recorded, used to say how much is left, in what order to run, and which tests are quick."""
