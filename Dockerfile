# The riveting cell in a container:  docker build -t pn2code .  &&  docker run --rm -v "$PWD/run:/home/cell/run" pn2code
# The first stage has what building needs, the second what running needs: Python 3.11, for which there is a PyBullet,
# a C compiler and make for the generated supervisor, and an environment with the wheel.
FROM debian:12-slim AS build
RUN apt-get update \
    && apt-get install -y --no-install-recommends python3 python3-venv python3-dev gcc g++ libc6-dev \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /source
COPY pyproject.toml README.md LICENSE ./
COPY src src
COPY cnative cnative
COPY templates templates
COPY examples examples
RUN python3 -m venv /opt/pn2code \
    && /opt/pn2code/bin/pip install --no-cache-dir '.[cell,hulls]'

FROM debian:12-slim
RUN apt-get update \
    && apt-get install -y --no-install-recommends python3 gcc libc6-dev make libgl1 libegl1 \
    && rm -rf /var/lib/apt/lists/* \
    && useradd --create-home --uid 1000 cell
COPY --from=build /opt/pn2code /opt/pn2code
COPY examples /opt/examples
ENV PATH=/opt/pn2code/bin:$PATH
USER cell
WORKDIR /home/cell
CMD ["pn2code", "run", "/opt/examples/riveting"]
