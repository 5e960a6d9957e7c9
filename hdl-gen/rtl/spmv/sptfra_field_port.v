// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// A copy of the field memory that reads all that makes a taxel's force in a cycle: A_p r of its three components, |w|.
//
// Written a quad at a time, as sptfra_field is. From quad and member to the values: 4 enabled cycles.

`default_nettype none

module sptfra_field_port #(
    // Quads of the grid
    parameter QUADS = 25,
    // Bits of A_p r and of |w|
    parameter DATA_BITS = 27,
    // Derived
    parameter ROW_WIDTH = (QUADS > 8) ? $clog2(QUADS) : 3
) (
    input  wire clock,
    // Weights
    input  wire weights_valid,
    input  wire [1:0] weights_bank,
    input  wire [ROW_WIDTH-1:0] weights_row,
    input  wire [4*DATA_BITS-1:0] weights,
    // A_p r, of one component at a time
    input  wire [2:0] taxel_force,
    input  wire taxel_bank,
    input  wire [ROW_WIDTH-1:0] taxel_row,
    input  wire [4*DATA_BITS-1:0] taxels,
    // Read
    input  wire enable,
    input  wire read_bank,
    input  wire [1:0] weight_read_bank,
    input  wire [ROW_WIDTH-1:0] quad,
    input  wire [1:0] member,
    output reg  [3*DATA_BITS-1:0] forces, // x in the lowest bits
    output reg  [DATA_BITS-1:0] weight
);

    reg [ROW_WIDTH:0] force_address_1;
    reg [ROW_WIDTH+1:0] weight_address_1;
    reg [1:0] member_1;
    reg [1:0] member_2;
    reg [1:0] member_3;
    reg [12*DATA_BITS-1:0] forces_3; // component after component
    reg [4*DATA_BITS-1:0] weights_3;
    wire [12*DATA_BITS-1:0] forces_2;
    wire [4*DATA_BITS-1:0] weights_2;
    genvar p;
    genvar index;

    generate
        for (index = 0; index < 4; index = index + 1) begin : gen_members
            sptfra_ram #(
                .WIDTH         (DATA_BITS),
                .DEPTH         (4 << ROW_WIDTH),
                .ADDRESS_WIDTH (ROW_WIDTH + 2)
            ) quad_weights (
                .clock         (clock),
                .write_enable  (weights_valid),
                .write_address ({weights_bank, weights_row}),
                .write_data    (weights[DATA_BITS*index +: DATA_BITS]),
                .read_enable   (enable),
                .read_address  (weight_address_1),
                .read_data     (weights_2[DATA_BITS*index +: DATA_BITS])
            );

            for (p = 0; p < 3; p = p + 1) begin : gen_components
                sptfra_ram #(
                    .WIDTH         (DATA_BITS),
                    .DEPTH         (2 << ROW_WIDTH),
                    .ADDRESS_WIDTH (ROW_WIDTH + 1)
                ) quad_forces (
                    .clock         (clock),
                    .write_enable  (taxel_force[p]),
                    .write_address ({taxel_bank, taxel_row}),
                    .write_data    (taxels[DATA_BITS*index +: DATA_BITS]),
                    .read_enable   (enable),
                    .read_address  (force_address_1),
                    .read_data     (forces_2[DATA_BITS*(4*p+index) +: DATA_BITS])
                );
            end
        end

        for (p = 0; p < 3; p = p + 1) begin : gen_forces
            wire [4*DATA_BITS-1:0] of_members = forces_3[4*DATA_BITS*p +: 4*DATA_BITS];

            always @(posedge clock) begin
                if (enable) begin
                    forces[DATA_BITS*p +: DATA_BITS] <= of_members[DATA_BITS*member_3 +: DATA_BITS];
                end
            end
        end
    endgenerate

    always @(posedge clock) begin
        if (enable) begin
            force_address_1 <= {read_bank, quad};
            weight_address_1 <= {weight_read_bank, quad};
            member_1 <= member;
            member_2 <= member_1;
            member_3 <= member_2;
            forces_3 <= forces_2;
            weights_3 <= weights_2;
            weight <= weights_3[DATA_BITS*member_3 +: DATA_BITS];
        end
    end

endmodule

`default_nettype wire
