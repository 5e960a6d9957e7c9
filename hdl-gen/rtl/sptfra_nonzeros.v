// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Lists the quads at which |w|, and those at which y+, is not zero: only these cost the lanes a cycle.
//
// Filled as We writes the folded vectors. A vector without any such quad counts as having one, quad 0.

`default_nettype none

module sptfra_nonzeros #(
    // Quads of the folded grid
    parameter ELEMENTS = 25,
    // Bits of a class
    parameter DATA_BITS = 27,
    // Derived
    parameter ROW_WIDTH = (ELEMENTS > 8) ? $clog2(ELEMENTS) : 3
) (
    input  wire clock,
    input  wire reset,
    input  wire clear, // a frame begins
    // What We writes: |w|, then y+ of the same quad
    input  wire we_valid,
    input  wire we_pull, // rather than |w|
    input  wire [ROW_WIDTH-1:0] we_quad,
    input  wire [4*DATA_BITS-1:0] we_data,
    // To the sequencer: one cycle from address to quad
    input  wire pull, // which list
    input  wire [ROW_WIDTH-1:0] address,
    output wire [ROW_WIDTH-1:0] quad,
    output wire [ROW_WIDTH+7:0] count
);

    localparam DEPTH = 1 << ROW_WIDTH;

    reg push_press;
    reg push_pull;
    reg [ROW_WIDTH-1:0] push_quad;
    reg [ROW_WIDTH:0] press_count;
    reg [ROW_WIDTH:0] pull_count;
    reg pull_read;
    wire [ROW_WIDTH-1:0] press_quad;
    wire [ROW_WIDTH-1:0] pull_quad;
    wire nothing_read = pull_read ? (pull_count == {(ROW_WIDTH+1){1'b0}}) : (press_count == {(ROW_WIDTH+1){1'b0}});

    assign count = {7'd0, pull ? pull_count : press_count};
    assign quad = nothing_read ? {ROW_WIDTH{1'b0}} : pull_read ? pull_quad : press_quad;

    always @(posedge clock) begin
        push_press <= we_valid && !we_pull && (we_data != {(4*DATA_BITS){1'b0}});
        push_pull <= we_valid && we_pull && (we_data != {(4*DATA_BITS){1'b0}});
        push_quad <= we_quad;
        pull_read <= pull;
        if (push_press) begin
            press_count <= press_count + 1;
        end
        if (push_pull) begin
            pull_count <= pull_count + 1;
        end
        if (reset || clear) begin
            press_count <= {(ROW_WIDTH+1){1'b0}};
            pull_count <= {(ROW_WIDTH+1){1'b0}};
        end
        if (reset) begin
            push_press <= 1'b0;
            push_pull <= 1'b0;
        end
    end

    sptfra_ram #(
        .WIDTH         (ROW_WIDTH),
        .DEPTH         (DEPTH),
        .ADDRESS_WIDTH (ROW_WIDTH)
    ) press_list (
        .clock         (clock),
        .write_enable  (push_press),
        .write_address (press_count[ROW_WIDTH-1:0]),
        .write_data    (push_quad),
        .read_enable   (1'b1),
        .read_address  (address),
        .read_data     (press_quad)
    );

    sptfra_ram #(
        .WIDTH         (ROW_WIDTH),
        .DEPTH         (DEPTH),
        .ADDRESS_WIDTH (ROW_WIDTH)
    ) pull_list (
        .clock         (clock),
        .write_enable  (push_pull),
        .write_address (pull_count[ROW_WIDTH-1:0]),
        .write_data    (push_quad),
        .read_enable   (1'b1),
        .read_address  (address),
        .read_data     (pull_quad)
    );

endmodule

`default_nettype wire
