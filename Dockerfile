# The program in Debian 12. docker build -t selvedge . makes the image, and this runs it on the present folder:
#   docker run --rm -v "$PWD:/work" selvedge simulate my.yaml --out out/mine
# cmake/try-dockerfile.sh runs these commands in an empty Debian folder.
FROM debian:12
RUN apt-get update && apt-get install --yes --no-install-recommends make
COPY . /selvedge
RUN make -C /selvedge program
RUN cmake --install /selvedge/build/release --prefix /usr/local
WORKDIR /work
ENTRYPOINT ["selvedge"]
