// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The u_q of two frames by orbit: filled as they arrive, read an orbit a cycle. From u_values to the memory: 1 cycle;
// from read_orbit to the values: 1 cycle.
//
// On a centre line of the grid images of an orbit coincide: only the first of them counts, the others are zero.

`default_nettype none

module sptfra_taxel_memory #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Bits of u_q
    parameter integer DATA_BITS = 27,
    // Bits of the number of an orbit
    parameter integer ROW_WIDTH = 5
) (
    input  wire clock,
    input  wire reset,
    // u_q of an orbit's taxels, image 0 in the lowest bits
    input  wire [2:0] u_valid, // q, one-hot
    input  wire fill_bank,
    input  wire [ROW_WIDTH-1:0] u_orbit,
    input  wire [4*DATA_BITS-1:0] u_values,
    // All of an orbit, u_0 in the lowest bits
    input  wire read_bank,
    input  wire [ROW_WIDTH-1:0] read_orbit,
    output wire [3*4*27-1:0] read_values
);

    // ---- A register on the way to the memory. An orbit's images beyond its own are 0
    reg [2:0] valid;
    reg bank;
    reg [ROW_WIDTH-1:0] orbit;
    wire [3:0] counts;
    wire [4*27-1:0] wide;

    always @(posedge clock) begin
        valid <= u_valid;
        bank <= fill_bank;
        orbit <= u_orbit;
        if (reset) begin
            valid <= 3'd0;
            bank <= 1'b0;
        end
    end

    sptfra_orbit_images #(
        .COLUMNS   (COLUMNS),
        .ROWS      (ROWS),
        .ROW_WIDTH (ROW_WIDTH)
    ) images (
        .orbit  (u_orbit),
        .counts (counts)
    );

    genvar index;

    for (index = 0; index < 4; index = index + 1) begin : gen_images
        reg signed [DATA_BITS-1:0] value;

        always @(posedge clock) begin
            value <= u_values[DATA_BITS*index +: DATA_BITS];
            if (!counts[index]) begin
                value <= {DATA_BITS{1'b0}};
            end
        end

        assign wide[27*index +: 27] = { {(28 - DATA_BITS){value[DATA_BITS-1]}}, value[DATA_BITS-2:0]};
    end

    // ---- Memory, one for each q
    for (index = 0; index < 3; index = index + 1) begin : gen_memories
        sptfra_ram #(
            .WIDTH         (4 * 27),
            .DEPTH         (2 << ROW_WIDTH),
            .ADDRESS_WIDTH (ROW_WIDTH + 1)
        ) of_q (
            .clock         (clock),
            .write_enable  (valid[index]),
            .write_address ({bank, orbit}),
            .write_data    (wide),
            .read_enable   (1'b1),
            .read_address  ({read_bank, read_orbit}),
            .read_data     (read_values[4*27*index +: 4*27])
        );
    end

endmodule

`default_nettype wire
