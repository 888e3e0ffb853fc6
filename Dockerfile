# The image of Coaxial: the server with its page and its dependencies, run by a user who is not root.
#
# The server listens where `server.host` of the config says: 127.0.0.1 if nothing is said, also in here. Start it
# in the host's network (docker run --network host), or mount a config that opens it knowingly; README has both.

# ---------------------------------------------------------------- the page
FROM node:24-bookworm-slim AS page
WORKDIR /build/web
COPY web/package.json web/package-lock.json ./
RUN npm ci --no-audit --no-fund
COPY web ./
RUN npm run build && test -s dist/index.html

# ---------------------------------------------------------------- the guide
FROM python:3.13-slim-bookworm AS guide
ENV PIP_NO_CACHE_DIR=1 PIP_DISABLE_PIP_VERSION_CHECK=1
WORKDIR /build
COPY requirements-docs.lock ./
RUN python -m pip install --require-hashes --no-deps -r requirements-docs.lock
COPY docs docs
RUN python -m zensical build --strict --clean --config-file docs/zensical.toml && test -s docs/site/index.html

# ---------------------------------------------------------------- the packages
FROM python:3.13-slim-bookworm AS packages
ENV PIP_NO_CACHE_DIR=1 PIP_DISABLE_PIP_VERSION_CHECK=1
WORKDIR /build
COPY requirements.lock requirements-build.lock ./
RUN python -m venv --without-pip /opt/coaxial \
    && python -m pip --python /opt/coaxial install --require-hashes --no-deps -r requirements.lock \
    && python -m pip install --require-hashes --no-deps -r requirements-build.lock
COPY pyproject.toml README.md LICENSE config.yaml ./
COPY tracker tracker
COPY server server
COPY --from=page /build/web/dist web/dist
COPY --from=guide /build/docs/site docs/site
RUN python -m hatchling build -t wheel -d wheels \
    && python -m pip --python /opt/coaxial install --no-index --no-deps wheels/*.whl

# ---------------------------------------------------------------- what runs
FROM python:3.13-slim-bookworm
LABEL org.opencontainers.image.title="Coaxial" \
    org.opencontainers.image.description="Navigation dashboard for pedicle-screw surgery by video. Research software, not a medical device." \
    org.opencontainers.image.licenses="Apache-2.0"
RUN useradd --system --uid 10001 --groups video --home-dir /var/lib/coaxial --shell /usr/sbin/nologin coaxial \
    && install --directory --owner coaxial /var/lib/coaxial /var/cache/coaxial
COPY --from=packages /opt/coaxial /opt/coaxial
COPY config.yaml /etc/coaxial/config.yaml
ENV PATH=/opt/coaxial/bin:$PATH \
    PYTHONUNBUFFERED=1 \
    COAXIAL_HOME=/var/lib/coaxial \
    COAXIAL_PORT=8000 \
    NUMBA_CACHE_DIR=/var/cache/coaxial
USER 10001
WORKDIR /etc/coaxial
# Compiled now, so that the first image is not late. On another kind of processor it is compiled at the start.
RUN python -m server.loop.compiling
VOLUME /var/lib/coaxial
EXPOSE 8000
HEALTHCHECK --interval=10s --timeout=3s --start-period=30s --retries=3 \
    CMD ["python", "-c", "import os, urllib.request as u; u.urlopen(f\"http://127.0.0.1:{os.environ['COAXIAL_PORT']}/health\", timeout=2)"]
ENTRYPOINT ["coaxial"]
CMD ["run"]
